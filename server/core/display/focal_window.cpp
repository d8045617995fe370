// SPDX-License-Identifier: Apache-2.0
#include "display/focal_window.h"

#include <algorithm>
#include <cmath>

namespace viewloom {

double focalDistance(double wanted_m, const StreamDefaults& defaults) {
  if (wanted_m > 0) return wanted_m;
  // A stream of sky alone has no finite middle distance, one of garbage none at all.
  if (std::isnan(defaults.focal_distance_m)) return StreamDefaults{}.focal_distance_m;
  return std::clamp(defaults.focal_distance_m, kFocalDistanceMin_m, kFocalDistanceMax_m);
}

FocalWindow focalWindow(double distance_m, double fov_y_rad, double aspect,
                        const StreamDefaults& defaults) {
  if (fov_y_rad > 0) {
    const double half_height_m = distance_m * std::tan(fov_y_rad / 2);
    return {.center_m = glm::dvec2(0.0),
            .half_size_m = {half_height_m * aspect, half_height_m},
            .distance_m = distance_m};
  }
  // Image point u lies at x = (u - principal) / focal * distance on the plane; rows run downwards.
  const Intrinsics& source = defaults.source_intrinsics;
  const glm::dvec2 size_px(defaults.source_size_px.width, defaults.source_size_px.height);
  const glm::dvec2 middle = (size_px / 2.0 - source.principal_px) / source.focal_px * distance_m;
  const glm::dvec2 half_m = size_px / 2.0 / source.focal_px * distance_m;
  return {
      .center_m = {middle.x, -middle.y},
      .half_size_m = {std::min(half_m.x, half_m.y * aspect), std::min(half_m.y, half_m.x / aspect)},
      .distance_m = distance_m};
}

Camera cameraThroughWindow(const FocalWindow& window, const glm::dvec3& eye_m,
                           SizePx tile_size_px) {
  // A point at x on the plane falls on u = focal * (x - eye) / distance + principal, by the eye's
  // own distance; the window's left edge shall be u = 0, its right edge u = width. The same in y,
  // where rows run downwards.
  const glm::dvec2 tile_px(tile_size_px.width, tile_size_px.height);
  const glm::dvec2 px_per_m = tile_px / (2.0 * window.half_size_m);
  const glm::dvec2 beside_px = px_per_m * (glm::dvec2(eye_m) - window.center_m);
  Camera camera;
  camera.pose.position_m = eye_m;
  camera.intrinsics.focal_px = px_per_m * (window.distance_m + eye_m.z);
  camera.intrinsics.principal_px = {tile_px.x / 2 + beside_px.x, tile_px.y / 2 - beside_px.y};
  return camera;
}

}  // namespace viewloom
