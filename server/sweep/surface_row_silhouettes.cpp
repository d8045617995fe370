// SPDX-License-Identifier: Apache-2.0
// The silhouettes of a row: what SurfaceRowBuilder makes of the edges where nothing is linked.
#include <algorithm>

#include "sweep/link_bytes.h"
#include "sweep/surface_row_builder.h"

namespace viewloom {

// Where rays pass behind the layer: surfaces begin, for those that come from the left, or end; or
// it goes on from a nearer layer, which the ray has been behind before.
void SurfaceRowBuilder::addSilhouettes(uint32_t layer) {
  const LayerScratch& scratch = layers_[layer];
  for (const Travel travel : {Travel::kLeft, Travel::kRight}) {
    const bool goes_left = travel == Travel::kLeft;
    const uint8_t* const links = goes_left ? scratch.to_right.data() : scratch.to_left.data();
    for (uint32_t x = 0; x < width_; ++x) {
      x = findOther(links, x, width_, uint8_t(layer + 1));
      const uint8_t link = x < width_ && !isSilhouette(links[x]) ? links[x] : uint8_t{0};
      if (x >= width_ || link > layer) continue;
      if (link > 0 && hasFault(SweepFault::kGoesOnBehind)) continue;
      addSilhouette(layer, travel, x, link);
    }
  }
}

// Rays that enter `column` pass behind its facet. Their far side is the surface that they were over
// before; at the border of the image, the facet itself.
void SurfaceRowBuilder::addSilhouette(uint32_t layer, Travel travel, uint32_t column,
                                      uint8_t link) {
  const bool goes_left = travel == Travel::kLeft;
  const LayerScratch& scratch = layers_[layer];
  const int64_t before = goes_left ? int64_t{column} + 1 : int64_t{column} - 1;
  const auto edgeBefore = [&](uint32_t of_layer) {
    return goes_left ? layers_[of_layer].left[size_t(before)]
                     : layers_[of_layer].right[size_t(before)];
  };
  const bool is_border = before < 0 || before >= int64_t{width_};
  if (is_border && hasFault(SweepFault::kEntryInFront)) return;
  const bool is_over = !is_border && inv_z_[layer][before] >= 0;
  const float own = goes_left ? scratch.right[column] : scratch.left[column];
  const float high = link == 0 ? own : std::min(own, edgeBefore(link - 1U));
  const float low = is_over ? edgeBefore(layer) : 0;
  Step step = {.edge_px = goes_left ? float(column + 1) : float(column),
               .low_inv_z = low,
               .high_inv_z = high};
  Steps& silhouettes = made_.layers[layer].silhouettes[size_t(travel)];
  const auto texelOf = [&](size_t at) {
    return (layer == 0 ? made_.nearest_texel : scratch.texel)[at];
  };
  if (link == 0 && !is_border) step.near_texel = texelOf(column);
  const bool has_far_side = link == 0 && (is_border || is_over);
  const bool is_deep = is_border || own * (1.0F - abi::kDeepStep) > low;
  if (has_far_side && low < high && !is_deep) {
    step.texel = addBetween(texelOf(size_t(before)), texelOf(column));
    step.texel_per_inv_z = kSubtexelSteps / (high - low);
  } else if (has_far_side) {
    step.texel = texelOf(is_border ? column : size_t(before));
  }
  step.addTo(silhouettes);
}

// Texels from that of a far side to that of the near one.
int32_t SurfaceRowBuilder::addBetween(int32_t far_texel, int32_t near_texel) {
  const uint32_t base = made_.texel_count;
  for (const int32_t from : {far_texel, near_texel, near_texel}) {
    const size_t index = size_t(from / kSubtexelSteps);
    made_.texels[made_.texel_count] = made_.texels[index];
    made_.texel_layer[made_.texel_count++] = made_.texel_layer[index];
  }
  return int32_t(base) * kSubtexelSteps;
}

}  // namespace viewloom
