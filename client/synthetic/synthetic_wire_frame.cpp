// SPDX-License-Identifier: Apache-2.0
#include "synthetic/synthetic_wire_frame.h"

#include <cstring>
#include <memory>
#include <utility>

#include "frame/cube_map.h"

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
  } else if (kind == v1::PLANE_KIND_COLOR) {
    plane.set_transfer(v1::COLOR_TRANSFER_SRGB);
  } else if (kind == v1::PLANE_KIND_NORMAL) {
    plane.set_normal_space(v1::NORMAL_SPACE_WORLD);
  }
  frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(std::move(bytes)));
}

void setPose(const Pose& from, v1::Pose& to) {
  to.mutable_position()->set_x(from.position_m.x);
  to.mutable_position()->set_y(from.position_m.y);
  to.mutable_position()->set_z(from.position_m.z);
  to.mutable_orientation()->set_x(from.orientation.x);
  to.mutable_orientation()->set_y(from.orientation.y);
  to.mutable_orientation()->set_z(from.orientation.z);
  to.mutable_orientation()->set_w(from.orientation.w);
}

void setIntrinsics(const Intrinsics& from, v1::Intrinsics& to) {
  to.set_focal_x_px(from.focal_px.x);
  to.set_focal_y_px(from.focal_px.y);
  to.set_principal_x_px(from.principal_px.x);
  to.set_principal_y_px(from.principal_px.y);
}

void setCamera(const Camera& from, v1::Camera& to) {
  setPose(from.pose, *to.mutable_pose());
  setIntrinsics(from.intrinsics, *to.mutable_intrinsics());
}

void addLayers(SizePx size_px, std::vector<SyntheticLayer> layers, v1::Source& source,
               WireFrame& frame) {
  for (SyntheticLayer& from : layers) {
    v1::Layer& layer = *source.add_layers();
    std::vector<uint8_t> depth_bytes(from.depth_m.size() * sizeof(float));
    std::memcpy(depth_bytes.data(), from.depth_m.data(), depth_bytes.size());
    addPlane(v1::PLANE_KIND_COLOR, v1::PLANE_ENCODING_RGBA8, size_px, std::move(from.color), layer,
             frame);
    addPlane(v1::PLANE_KIND_DEPTH, v1::PLANE_ENCODING_DEPTH_F32, size_px, std::move(depth_bytes),
             layer, frame);
    if (!from.motion.empty()) {
      std::vector<uint8_t> motion_bytes(from.motion.size() * sizeof(uint16_t));
      std::memcpy(motion_bytes.data(), from.motion.data(), motion_bytes.size());
      addPlane(v1::PLANE_KIND_MOTION, v1::PLANE_ENCODING_XYZ16F, size_px, std::move(motion_bytes),
               layer, frame);
    }
    if (from.specular.empty()) continue;
    std::vector<uint8_t> normal_bytes(from.normal.size() * sizeof(uint32_t));
    std::memcpy(normal_bytes.data(), from.normal.data(), normal_bytes.size());
    addPlane(v1::PLANE_KIND_NORMAL, v1::PLANE_ENCODING_OCT16, size_px, std::move(normal_bytes),
             layer, frame);
    addPlane(v1::PLANE_KIND_ROUGHNESS, v1::PLANE_ENCODING_R8, size_px, std::move(from.roughness),
             layer, frame);
    addPlane(v1::PLANE_KIND_SPECULAR, v1::PLANE_ENCODING_RGB8, size_px, std::move(from.specular),
             layer, frame);
  }
}

template <typename Value>
void append(const std::vector<Value>& from, std::vector<Value>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

WireFrame syntheticWireFrame(const SyntheticOptions& options, int64_t capture_time_ns) {
  WireFrame frame;
  frame.header.set_capture_time_ns(capture_time_ns);
  addSyntheticSource(options, frame);
  return frame;
}

void addSyntheticSource(const SyntheticOptions& options, WireFrame& frame) {
  addLayeredSource(options.camera.value_or(syntheticCamera(options.size_px)), options.size_px,
                   renderSyntheticFrame(options), frame);
}

v1::Source& addLayeredSource(const Camera& camera, SizePx size_px,
                             std::vector<SyntheticLayer> layers, WireFrame& frame) {
  v1::Source& source = *frame.header.add_sources();
  setCamera(camera, *source.mutable_camera());
  addLayers(size_px, std::move(layers), source, frame);
  return source;
}

void addSyntheticCubeMap(const SyntheticOptions& options, WireFrame& frame) {
  const uint32_t side_px = options.size_px.height;
  v1::Source& source = *frame.header.add_sources();
  source.set_cube_map(true);
  const Pose pose = options.camera.value_or(Camera{}).pose;
  setPose(pose, *source.mutable_camera()->mutable_pose());
  std::vector<SyntheticLayer> stacked(options.layer_count);
  SyntheticOptions of_face = options;
  of_face.size_px = {side_px, side_px};
  for (uint32_t face = 0; face < kCubeFaceCount; ++face) {
    of_face.camera = cubeFaceCamera(pose, face, side_px);
    const std::vector<SyntheticLayer> layers = renderSyntheticFrame(of_face);
    for (size_t i = 0; i < layers.size(); ++i) {
      append(layers[i].color, stacked[i].color);
      append(layers[i].depth_m, stacked[i].depth_m);
    }
  }
  addLayers({side_px, kCubeFaceCount * side_px}, std::move(stacked), source, frame);
}

}  // namespace viewloom
