// SPDX-License-Identifier: Apache-2.0
#include "trace/face_rays.h"

#include <algorithm>
#include <array>

#include "shared/cube_abi.h"

namespace viewloom {
namespace {

// How far a homogeneous point is inside of what bounds a face: its sides, and the nearest surface.
// `unit`: of the point, 0 for a direction.
std::array<float, 5> insideOf(const abi::vec3& point, float unit, SizePx size_px,
                              float inv_z_near) {
  const float own_px = float(abi::kCubeApron_px) - abi::kSeamOverlap_px;
  const float side_px = float(size_px.width) - own_px;
  return {point.x - own_px * point.z, point.y - own_px * point.z, side_px * point.z - point.x,
          side_px * point.z - point.y, inv_z_near * point.z - unit};
}

// Each bound is linear along a ray, and its directions are over a tile: corners decide.
bool mayEnter(const abi::ViewParams& tile, SizePx tile_px, SizePx size_px, float inv_z_near) {
  std::array<float, 5> most = insideOf(tile.eye, 1, size_px, inv_z_near);
  for (const float x_px : {0.0F, float(tile_px.width)}) {
    for (const float y_px : {0.0F, float(tile_px.height)}) {
      const abi::vec3 direction =
          tile.direction + x_px * tile.direction_dx + y_px * tile.direction_dy;
      const std::array<float, 5> inside = insideOf(direction, 0, size_px, inv_z_near);
      for (size_t i = 0; i < most.size(); ++i) most[i] = std::max(most[i], inside[i]);
    }
  }
  return std::none_of(most.begin(), most.end(), [](float inside) { return inside < 0; });
}

}  // namespace

bool raysMayEnterFace(const TileRays& rays, SizePx size_px, double inv_z_max) {
  const float inv_z_near = std::max(float(inv_z_max), abi::kInvZNearMin) * abi::kInvZNearMargin;
  // Rays from eyes between two that do not enter may do so.
  if (rays.are_bounds) return true;
  return std::any_of(rays.tiles.begin(), rays.tiles.end(), [&](const abi::ViewParams& tile) {
    return tile.is_used != 0 && mayEnter(tile, rays.tile_px, size_px, inv_z_near);
  });
}

}  // namespace viewloom
