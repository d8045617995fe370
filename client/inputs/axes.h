// SPDX-License-Identifier: Apache-2.0
// Poses from the axes of a camera, as other tools state them in spaces of their own.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "viewloom/v1/geometry.pb.h"

namespace viewloom::inputs {

// Where a camera stands and which ways it looks, in viewloom's world: metres, right-handed, +y up.
struct CameraAxes {
  glm::dvec3 position_m{0.0};
  glm::dvec3 right{1, 0, 0};  // unit length, at right angles with up; forward follows
  glm::dvec3 up{0, 1, 0};
};

v1::Pose poseOf(const CameraAxes& axes);

// A pinhole with square or oblong px: `fov_x_deg` across the width.
v1::Intrinsics intrinsicsAcross(double fov_x_deg, double width_px, double height_px,
                                double pixel_aspect);

}  // namespace viewloom::inputs
