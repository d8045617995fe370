// SPDX-License-Identifier: Apache-2.0
#include "e2e/wire_frames.h"

#include <cstring>
#include <utility>
#include <vector>

#include "synthetic/synthetic_frame.h"

namespace viewloom::test {
namespace {

SharedBytes share(std::vector<uint8_t> bytes) {
  return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
}

void addPlane(v1::Layer& layer, v1::PlaneKind kind, v1::PlaneEncoding encoding, SizePx size_px,
              size_t bytes_count) {
  v1::Plane& plane = *layer.add_planes();
  plane.set_kind(kind);
  plane.set_encoding(encoding);
  plane.mutable_size()->set_width(size_px.width);
  plane.mutable_size()->set_height(size_px.height);
  plane.set_bytes_count(bytes_count);
  if (kind == v1::PLANE_KIND_DEPTH) {
    plane.mutable_depth()->set_meaning(v1::DEPTH_MEANING_PLANAR);
  }
}

// Its pose is the default: the origin, looking along -z.
void setCamera(v1::Camera& to, const Camera& camera) {
  v1::Intrinsics& intrinsics = *to.mutable_intrinsics();
  intrinsics.set_focal_x_px(camera.intrinsics.focal_px.x);
  intrinsics.set_focal_y_px(camera.intrinsics.focal_px.y);
  intrinsics.set_principal_x_px(camera.intrinsics.principal_px.x);
  intrinsics.set_principal_y_px(camera.intrinsics.principal_px.y);
}

}  // namespace

WireFrame syntheticWireFrame(SizePx size_px, uint32_t layer_count, double time_s) {
  WireFrame frame;
  v1::Source& source = *frame.header.add_sources();
  setCamera(*source.mutable_camera(), syntheticCamera(size_px));
  const SyntheticOptions options{.size_px = size_px,
                                 .layer_count = layer_count,
                                 .time_s = time_s,
                                 .camera = {},
                                 .thread_count = 1};
  for (SyntheticLayer& layer : renderSyntheticFrame(options)) {
    std::vector<uint8_t> depth(layer.depth_m.size() * sizeof(float));
    std::memcpy(depth.data(), layer.depth_m.data(), depth.size());
    v1::Layer& declared = *source.add_layers();
    addPlane(declared, v1::PLANE_KIND_COLOR, v1::PLANE_ENCODING_RGBA8, size_px, layer.color.size());
    addPlane(declared, v1::PLANE_KIND_DEPTH, v1::PLANE_ENCODING_DEPTH_F32, size_px, depth.size());
    frame.planes.push_back(share(std::move(layer.color)));
    frame.planes.push_back(share(std::move(depth)));
  }
  return frame;
}

v1::OpenDisplay openQuilt(const std::string& stream, SizePx size_px) {
  v1::OpenDisplay open;
  open.set_stream(stream);
  open.set_wait_for_stream(true);
  v1::QuiltDisplay& quilt = *open.mutable_display()->mutable_quilt();
  quilt.set_columns(4);
  quilt.set_rows(2);
  quilt.mutable_size()->set_width(size_px.width);
  quilt.mutable_size()->set_height(size_px.height);
  return open;
}

}  // namespace viewloom::test
