// SPDX-License-Identifier: Apache-2.0
// Projections of a point on a display's axis into its views, by a textbook pinhole camera.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "frame/camera.h"

namespace viewloom {

// Where a camera that is not turned sees the point z_m in front of the origin, px.
inline glm::dvec2 axisPointIn(const Camera& camera, double z_m) {
  return glm::dvec2(1, -1) * camera.intrinsics.focal_px * glm::dvec2(-camera.pose.position_m) /
             z_m +
         camera.intrinsics.principal_px;
}

// How far its image moves from one to the other, px.
inline double axisPointStep_px(const Camera& from, const Camera& to, double z_m) {
  return glm::length(axisPointIn(from, z_m) - axisPointIn(to, z_m));
}

}  // namespace viewloom
