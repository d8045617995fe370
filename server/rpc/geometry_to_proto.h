// SPDX-License-Identifier: Apache-2.0
// Cameras and poses as the server tells them.
#pragma once

#include "frame/camera.h"
#include "viewloom/v1/geometry.pb.h"

namespace viewloom {

v1::SizePx sizeToProto(SizePx size_px);
v1::Pose poseToProto(const Pose& pose);
v1::Fov fovToProto(const Fov& fov);
// With intrinsics, the exact form.
v1::Camera cameraToProto(const Camera& camera);

}  // namespace viewloom
