// SPDX-License-Identifier: Apache-2.0
// Cameras and poses as clients send them, checked.
#pragma once

#include <string_view>
#include <variant>

#include "base/status.h"
#include "frame/camera.h"
#include "viewloom/v1/geometry.pb.h"

namespace viewloom {

SizePx sizeFromProto(const v1::SizePx& proto);

// An absent pose is the identity, an all-zero quaternion no rotation. The result is of unit length.
// Errors name `field` or what lies in it.
absl::StatusOr<Pose> poseFromProto(const v1::Pose& proto, std::string_view field);

// Angles or intrinsics, as given. Errors name the field inside the camera ("fov").
absl::StatusOr<std::variant<Fov, Intrinsics>> projectionFromProto(const v1::Camera& proto);

}  // namespace viewloom
