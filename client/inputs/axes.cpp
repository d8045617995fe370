// SPDX-License-Identifier: Apache-2.0
#include "inputs/axes.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace viewloom::inputs {

v1::Pose poseOf(const CameraAxes& axes) {
  const glm::dmat3 world_from_camera(axes.right, axes.up, glm::cross(axes.right, axes.up));
  const glm::dquat turn = glm::normalize(glm::quat_cast(world_from_camera));
  v1::Pose pose;
  v1::Vector3& position = *pose.mutable_position();
  position.set_x(axes.position_m.x);
  position.set_y(axes.position_m.y);
  position.set_z(axes.position_m.z);
  v1::Quaternion& orientation = *pose.mutable_orientation();
  orientation.set_x(turn.x);
  orientation.set_y(turn.y);
  orientation.set_z(turn.z);
  orientation.set_w(turn.w);
  return pose;
}

v1::Intrinsics intrinsicsAcross(double fov_x_deg, double width_px, double height_px,
                                double pixel_aspect) {
  const double focal_x_px = 0.5 * width_px / std::tan(0.5 * fov_x_deg * std::numbers::pi / 180);
  v1::Intrinsics intrinsics;
  intrinsics.set_focal_x_px(focal_x_px);
  intrinsics.set_focal_y_px(focal_x_px * pixel_aspect);
  intrinsics.set_principal_x_px(0.5 * width_px);
  intrinsics.set_principal_y_px(0.5 * height_px);
  return intrinsics;
}

}  // namespace viewloom::inputs
