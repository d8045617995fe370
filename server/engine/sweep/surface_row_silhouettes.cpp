// SPDX-License-Identifier: Apache-2.0
// The silhouettes of a row: what SurfaceRowBuilder makes of the edges where nothing is linked.
#include <algorithm>
#include <cmath>

#include "sweep/link_kernels.h"
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
// before; at the border of the image, the facet itself; where there was nothing, what lies beyond.
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
  const bool is_deep = is_border || own - steps_.deep.at(own) > low;
  if (has_far_side && low < high && !is_deep) {
    step.texel = addBetween(texelOf(size_t(before)), texelOf(column));
    step.texel_per_inv_z = kSubtexelSteps / (high - low);
  } else if (has_far_side) {
    step.texel = texelOf(is_border ? column : size_t(before));
  } else if (link == 0 && layer == 0) {
    step.texel = texelBeyondNothing(travel, column);
  }
  const bool goes_on = link == 0 && is_over && 0 < low && low < high;
  if (goes_on && !isKnownBehind(layer, travel, column) && !hasFault(SweepFault::kFarSideEnds)) {
    step.behind_px = goesOnInFront(layer, travel, column, low, (high - low) * px_per_inv_z_);
  }
  step.addTo(silhouettes);
}

// Whether deeper layers hold on this side of a silhouette what is as far back as its far side, or
// further: kKnownBehind of the structure, decided in the middle of the edge.
bool SurfaceRowBuilder::isKnownBehind(uint32_t layer, Travel travel, uint32_t column) const {
  const bool goes_left = travel == Travel::kLeft;
  const auto atEdge = [&](uint32_t of_layer, uint32_t x, bool is_right) {
    const float rise = 0.5F * layers_[of_layer].slope_x[x];
    return std::max(inv_z_[of_layer][x] + (is_right ? rise : -rise), 0.0F);
  };
  const float far = atEdge(layer, goes_left ? column + 1 : column - 1, !goes_left);
  // Where the row is not in the middle, the edge may be one there that rays pass the other way.
  if (atEdge(layer, column, goes_left) <= far) return false;
  for (uint32_t i = layer + 1; i < layer_count_; ++i) {
    if (inv_z_[i][column] < 0) continue;
    const float behind = atEdge(i, column, goes_left);
    if (behind - far <= steps_.kappa.at(std::max(behind, far))) return true;
  }
  return false;
}

// How far a layer is in front of a far side, from the edge of `column` where rays enter it on; no
// further than in the image, and by `reach_px` far enough. What is closer to the far side than runs
// stray from their facets does not count: rays hit the runs.
float SurfaceRowBuilder::goesOnInFront(uint32_t layer, Travel travel, uint32_t column,
                                       float far_inv_z, float reach_px) const {
  constexpr float kRounding = 1.0F + 8.0F / 8388608.0F;
  const float low_inv_z = (far_inv_z + tolerance_) * kRounding;
  const LayerScratch& scratch = layers_[layer];
  const bool goes_left = travel == Travel::kLeft;
  const float* const entered = goes_left ? scratch.right.data() : scratch.left.data();
  const float* const left = goes_left ? scratch.left.data() : scratch.right.data();
  const uint32_t column_count = goes_left ? column + 1 : width_ - column;
  for (uint32_t i = 0; i < column_count; ++i) {
    const uint32_t x = goes_left ? column - i : column + i;
    if (float(i) >= reach_px) return reach_px;
    if (inv_z_[layer][x] < 0 || entered[x] <= low_inv_z) return float(i);
    if (left[x] <= low_inv_z) {
      // What falls below the sky falls faster than its edges say.
      const float fall = std::max(std::abs(scratch.slope_x[x]), entered[x] - left[x]);
      return float(i) + (entered[x] - low_inv_z) / fall;
    }
  }
  return float(column_count);
}

// What shows of rays that come from a column without a surface: of the first one further back, at
// distances that double. As findFarSide in shaders/lib/walk/far_side.glsl.
int32_t SurfaceRowBuilder::texelBeyondNothing(Travel travel, uint32_t column) const {
  const float near = inv_z_[0][column];
  const float deep = near - steps_.deep.at(near);
  const float bound = steps_.deep.before(near);
  const int64_t back = travel == Travel::kLeft ? 1 : -1;
  for (uint32_t probe = 0; probe < abi::kFarSideProbes; ++probe) {
    const int64_t x = int64_t{column} + back * (1 + (int64_t{1} << probe));
    const size_t inside = size_t(std::clamp<int64_t>(x, 0, int64_t{width_} - 1));
    const float inv_z = inv_z_[0][inside];
    if (inv_z < 0 || inv_z >= bound) continue;
    return made_.nearest_texel[inv_z < deep ? inside : column];
  }
  return kBackgroundTexel;
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
