// SPDX-License-Identifier: Apache-2.0
// Cameras and poses, how views lie in an atlas, and how it is packed → proto AtlasLayout.
#pragma once

#include "display/atlas_layout.h"
#include "display/display_spec.h"
#include "frame/camera.h"
#include "viewloom/v1/atlas.pb.h"
#include "viewloom/v1/geometry.pb.h"

namespace viewloom {

v1::SizePx sizeToProto(SizePx size_px);
v1::Pose poseToProto(const Pose& pose);
v1::Fov fovToProto(const Fov& fov);
// With intrinsics, the exact form.
v1::Camera cameraToProto(const Camera& camera);

v1::BandEncoding bandEncodingToProto(BandEncoding encoding);
v1::AtlasEncoding encodingToProto(const EncodingSpec& encoding);

// Without views and encoding: what a preset says.
v1::AtlasLayout gridToProto(const AtlasLayout& layout);
// Everything.
v1::AtlasLayout layoutToProto(const AtlasLayout& layout, const EncodingSpec& encoding);

}  // namespace viewloom
