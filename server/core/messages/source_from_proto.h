// SPDX-License-Identifier: Apache-2.0
// Converts and checks cameras, poses and depth formats of clients.
#pragma once

#include <string_view>
#include <variant>

#include "base/status.h"
#include "frame/camera.h"
#include "frame/depth.h"
#include "viewloom/v1/frame.pb.h"
#include "viewloom/v1/geometry.pb.h"

namespace viewloom {

SizePx sizeFromProto(const v1::SizePx& proto);

// Converts a pose. An absent pose is the identity, and an all-zero quaternion no rotation. The
// result has unit length. Errors name `field` or a field inside it.
absl::StatusOr<Pose> poseFromProto(const v1::Pose& proto, std::string_view field);

// Projection of a camera: angles or intrinsics, as given. Errors name the field inside the camera
// ("fov").
absl::StatusOr<std::variant<Fov, Intrinsics>> projectionFromProto(const v1::Camera& proto);

// Converts a depth format and fills in every default. Refuses an unknown meaning. Errors name the
// field ("meaning"). validateDepthFormat checks the numbers.
absl::StatusOr<DepthFormat> depthFormatFromProto(const v1::DepthFormat& proto);

}  // namespace viewloom
