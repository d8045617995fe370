// SPDX-License-Identifier: Apache-2.0
// How many px of a source a px of the views covers, and so how far colour is averaged
// (shaders/color.md, Means).

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "picture/trace_job.h"

namespace viewloom {
namespace {

// Px of the source that the px in the middle of a tile covers along each axis, of what is
// infinitely far: steps along the rows and the columns of the tile, added as the sides of a
// turned px are.
glm::dvec2 footprintOf(const abi::ViewParams& tile, SizePx tile_px) {
  const glm::dvec3 step_x(tile.direction_dx);
  const glm::dvec3 step_y(tile.direction_dy);
  const glm::dvec3 middle =
      glm::dvec3(tile.direction) + 0.5 * tile_px.width * step_x + 0.5 * tile_px.height * step_y;
  // A view that looks away from the source's field of view has no use for averages.
  if (!(middle.z > 0)) return glm::dvec2(0);
  const glm::dvec2 vanishing = glm::dvec2(middle) / middle.z;
  const glm::dvec2 moved_x = (glm::dvec2(step_x) - vanishing * step_x.z) / middle.z;
  const glm::dvec2 moved_y = (glm::dvec2(step_y) - vanishing * step_y.z) / middle.z;
  return {std::hypot(moved_x.x, moved_y.x), std::hypot(moved_x.y, moved_y.y)};
}

// Interpolation spreads a mean by another px, half of it to each side; of footprints larger than
// one px by kFootprintMin_px - 1, means go as far as is missing.
float reachOf(double footprint_px) {
  const double reach_px = 0.5 * (footprint_px - double{abi::kFootprintMin_px});
  return float(std::clamp(reach_px, 0.0, double{abi::kColorReachMax_px}));
}

}  // namespace

ColorReach colorReach(std::span<const abi::ViewParams> tiles, SizePx tile_px) {
  glm::dvec2 least_px(1e9);
  for (const abi::ViewParams& tile : tiles) {
    if (tile.is_used != 0) least_px = glm::min(least_px, footprintOf(tile, tile_px));
  }
  return least_px.x == 1e9 ? ColorReach{} : ColorReach{reachOf(least_px.x), reachOf(least_px.y)};
}

}  // namespace viewloom
