// SPDX-License-Identifier: Apache-2.0
// Cameras, poses and the meaning of depth as clients send them, checked.
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

// An absent pose is the identity, an all-zero quaternion no rotation. The result is of unit length.
// Errors name `field` or what lies in it.
absl::StatusOr<Pose> poseFromProto(const v1::Pose& proto, std::string_view field);

// Angles or intrinsics, as given. Errors name the field inside the camera ("fov").
absl::StatusOr<std::variant<Fov, Intrinsics>> projectionFromProto(const v1::Camera& proto);

// Measure of the samples of a depth plane. Every default is filled in; refuses an unknown meaning.
// Errors name the field ("meaning"). The numbers are left to validateDepthFormat.
absl::StatusOr<DepthFormat> depthFormatFromProto(const v1::DepthFormat& proto);

}  // namespace viewloom
