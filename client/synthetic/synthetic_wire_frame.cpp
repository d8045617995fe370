// SPDX-License-Identifier: Apache-2.0
#include "synthetic/synthetic_wire_frame.h"

#include <cstring>
#include <memory>
#include <utility>

namespace viewloom {
namespace {

void addPlane(v1::PlaneKind kind, v1::PlaneEncoding encoding, SizePx size_px,
              std::vector<uint8_t> bytes, v1::Layer& layer, WireFrame& frame) {
  v1::Plane& plane = *layer.add_planes();
  plane.set_kind(kind);
  plane.set_encoding(encoding);
  plane.mutable_size()->set_width(size_px.width);
  plane.mutable_size()->set_height(size_px.height);
  plane.set_bytes_count(bytes.size());
  if (kind == v1::PLANE_KIND_DEPTH) {
    plane.mutable_depth()->set_meaning(v1::DEPTH_MEANING_PLANAR);
  } else {
    plane.set_transfer(v1::COLOR_TRANSFER_SRGB);
  }
  frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(std::move(bytes)));
}

void setCamera(const Camera& from, v1::Camera& to) {
  const glm::dvec3& position_m = from.pose.position_m;
  to.mutable_pose()->mutable_position()->set_x(position_m.x);
  to.mutable_pose()->mutable_position()->set_y(position_m.y);
  to.mutable_pose()->mutable_position()->set_z(position_m.z);
  const glm::dquat& orientation = from.pose.orientation;
  to.mutable_pose()->mutable_orientation()->set_x(orientation.x);
  to.mutable_pose()->mutable_orientation()->set_y(orientation.y);
  to.mutable_pose()->mutable_orientation()->set_z(orientation.z);
  to.mutable_pose()->mutable_orientation()->set_w(orientation.w);
  to.mutable_intrinsics()->set_focal_x_px(from.intrinsics.focal_px.x);
  to.mutable_intrinsics()->set_focal_y_px(from.intrinsics.focal_px.y);
  to.mutable_intrinsics()->set_principal_x_px(from.intrinsics.principal_px.x);
  to.mutable_intrinsics()->set_principal_y_px(from.intrinsics.principal_px.y);
}

}  // namespace

WireFrame syntheticWireFrame(const SyntheticOptions& options, int64_t capture_time_ns) {
  WireFrame frame;
  frame.header.set_capture_time_ns(capture_time_ns);
  addSyntheticSource(options, frame);
  return frame;
}

void addSyntheticSource(const SyntheticOptions& options, WireFrame& frame) {
  v1::Source& source = *frame.header.add_sources();
  setCamera(options.camera.value_or(syntheticCamera(options.size_px)), *source.mutable_camera());
  for (SyntheticLayer& from : renderSyntheticFrame(options)) {
    v1::Layer& layer = *source.add_layers();
    std::vector<uint8_t> depth_bytes(from.depth_m.size() * sizeof(float));
    std::memcpy(depth_bytes.data(), from.depth_m.data(), depth_bytes.size());
    addPlane(v1::PLANE_KIND_COLOR, v1::PLANE_ENCODING_RGBA8, options.size_px, std::move(from.color),
             layer, frame);
    addPlane(v1::PLANE_KIND_DEPTH, v1::PLANE_ENCODING_DEPTH_F32, options.size_px,
             std::move(depth_bytes), layer, frame);
  }
}

}  // namespace viewloom
