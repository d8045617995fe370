// SPDX-License-Identifier: Apache-2.0
#include "sweep/surface_row_silhouettes.h"

#include <algorithm>
#include <cmath>

#include "sweep/link_kernels.h"

namespace viewloom {

void SurfaceRowSilhouettes::add(uint32_t layer) {
  const LayerFacets& facets = row_.layers[layer];
  for (const Travel travel : {Travel::kLeft, Travel::kRight}) {
    const bool goes_left = travel == Travel::kLeft;
    const uint8_t* const links = goes_left ? facets.to_right.data() : facets.to_left.data();
    for (uint32_t x = 0; x < row_.width; ++x) {
      x = findOther(links, x, row_.width, uint8_t(layer + 1));
      const uint8_t link = x < row_.width && !isSilhouette(links[x]) ? links[x] : uint8_t{0};
      if (x >= row_.width || link > layer) continue;
      if (link > 0 && row_.hasFault(SweepFault::kGoesOnBehind)) continue;
      addSilhouette(layer, travel, x, link);
    }
  }
}

// Rays that enter `column` pass behind its facet. Their far side is the surface that they were over
// before; at the border of the image, the facet itself; where there was nothing, what lies beyond.
void SurfaceRowSilhouettes::addSilhouette(uint32_t layer, Travel travel, uint32_t column,
                                          uint8_t link) {
  const bool goes_left = travel == Travel::kLeft;
  const LayerFacets& facets = row_.layers[layer];
  const int64_t before = goes_left ? int64_t{column} + 1 : int64_t{column} - 1;
  const auto edgeBefore = [&](uint32_t of_layer) {
    return goes_left ? row_.layers[of_layer].left[size_t(before)]
                     : row_.layers[of_layer].right[size_t(before)];
  };
  const bool is_border = before < 0 || before >= int64_t{row_.width};
  if (is_border && row_.hasFault(SweepFault::kEntryInFront)) return;
  const bool is_over = !is_border && row_.inv_z[layer][before] >= 0;
  const float own = goes_left ? facets.right[column] : facets.left[column];
  const float high = link == 0 ? own : std::min(own, edgeBefore(link - 1U));
  const float low = is_over ? edgeBefore(layer) : 0;
  Step step = {.edge_px = goes_left ? float(column + 1) : float(column),
               .low_inv_z = low,
               .high_inv_z = high};
  Steps& silhouettes = made_.layers[layer].silhouettes[size_t(travel)];
  const auto texelOf = [&](size_t at) {
    return (layer == 0 ? made_.nearest_texel : facets.texel)[at];
  };
  if (link == 0 && !is_border) step.near_texel = texelOf(column);
  const bool has_far_side = link == 0 && (is_border || is_over);
  const bool is_deep = is_border || own - row_.steps.deep.at(own) > low;
  if (has_far_side && low < high && !is_deep) {
    step.texel = addBetween(texelOf(size_t(before)), texelOf(column));
    step.texel_per_inv_z = kSubtexelSteps / (high - low);
  } else if (has_far_side) {
    step.texel = texelOf(is_border ? column : size_t(before));
  } else if (link == 0 && layer == 0) {
    step.texel = texelBeyondNothing(travel, column);
  }
  const bool goes_on = link == 0 && is_over && 0 < low && low < high;
  if (goes_on && !isKnownBehind(layer, travel, column) &&
      !row_.hasFault(SweepFault::kFarSideEnds)) {
    step.behind_px = goesOnInFront(layer, travel, column, low, (high - low) * px_per_inv_z_);
  }
  step.addTo(silhouettes);
}

// Whether deeper layers hold on this side of a silhouette what is as far back as its far side, or
// further: kKnownBehind of the structure, decided in the middle of the edge.
bool SurfaceRowSilhouettes::isKnownBehind(uint32_t layer, Travel travel, uint32_t column) const {
  const bool goes_left = travel == Travel::kLeft;
  const auto atEdge = [&](uint32_t of_layer, uint32_t x, bool is_right) {
    const float rise = 0.5F * row_.layers[of_layer].slope_x[x];
    return std::max(row_.inv_z[of_layer][x] + (is_right ? rise : -rise), 0.0F);
  };
  const float far = atEdge(layer, goes_left ? column + 1 : column - 1, !goes_left);
  // Where the row is not in the middle, the edge may be one there that rays pass the other way.
  if (atEdge(layer, column, goes_left) <= far) return false;
  for (uint32_t i = layer + 1; i < row_.layer_count; ++i) {
    if (row_.inv_z[i][column] < 0) continue;
    const float behind = atEdge(i, column, goes_left);
    if (behind - far <= row_.steps.kappa.at(std::max(behind, far))) return true;
  }
  return false;
}

// How far a layer is in front of a far side, from the edge of `column` where rays enter it on; no
// further than in the image, and by `reach_px` far enough. What is closer to the far side than runs
// stray from their facets does not count: rays hit the runs.
float SurfaceRowSilhouettes::goesOnInFront(uint32_t layer, Travel travel, uint32_t column,
                                           float far_inv_z, float reach_px) const {
  constexpr float kRounding = 1.0F + 8.0F / 8388608.0F;
  const float low_inv_z = (far_inv_z + tolerance_) * kRounding;
  const LayerFacets& facets = row_.layers[layer];
  const bool goes_left = travel == Travel::kLeft;
  const float* const entered = goes_left ? facets.right.data() : facets.left.data();
  const float* const left = goes_left ? facets.left.data() : facets.right.data();
  const uint32_t column_count = goes_left ? column + 1 : row_.width - column;
  for (uint32_t i = 0; i < column_count; ++i) {
    const uint32_t x = goes_left ? column - i : column + i;
    if (float(i) >= reach_px) return reach_px;
    if (row_.inv_z[layer][x] < 0 || entered[x] <= low_inv_z) return float(i);
    if (left[x] <= low_inv_z) {
      // A surface that falls below the sky falls faster than its edges say.
      const float fall = std::max(std::abs(facets.slope_x[x]), entered[x] - left[x]);
      return float(i) + (entered[x] - low_inv_z) / fall;
    }
  }
  return float(column_count);
}

// Texel for rays from a column without a surface: the first one further back, at distances that
// double. The same as findFarSide in shaders/lib/walk/far_side.glsl.
int32_t SurfaceRowSilhouettes::texelBeyondNothing(Travel travel, uint32_t column) const {
  const float near = row_.inv_z[0][column];
  const float deep = near - row_.steps.deep.at(near);
  const float bound = row_.steps.deep.before(near);
  const int64_t back = travel == Travel::kLeft ? 1 : -1;
  for (uint32_t probe = 0; probe < abi::kFarSideProbes; ++probe) {
    const int64_t x = int64_t{column} + back * (1 + (int64_t{1} << probe));
    const size_t inside = size_t(std::clamp<int64_t>(x, 0, int64_t{row_.width} - 1));
    const float inv_z = row_.inv_z[0][inside];
    if (inv_z < 0 || inv_z >= bound) continue;
    return made_.nearest_texel[inv_z < deep ? inside : column];
  }
  return kBackgroundTexel;
}

// Texels from that of a far side to that of the near one.
int32_t SurfaceRowSilhouettes::addBetween(int32_t far_texel, int32_t near_texel) {
  const uint32_t base = made_.texel_count;
  for (const int32_t from : {far_texel, near_texel, near_texel}) {
    const size_t index = size_t(from / kSubtexelSteps);
    made_.texels[made_.texel_count] = made_.texels[index];
    made_.texel_layer[made_.texel_count++] = made_.texel_layer[index];
  }
  return int32_t(base) * kSubtexelSteps;
}

}  // namespace viewloom
