// SPDX-License-Identifier: Apache-2.0
#include "load/synthetic_loop.h"

#include <memory>
#include <utility>

#include "synthetic/synthetic_frame.h"

namespace viewloom::load {
namespace {

constexpr double kFrameTimeS = 0.1;

void declareCamera(const Camera& camera, v1::Camera& declared) {
  v1::Intrinsics& intrinsics = *declared.mutable_intrinsics();
  intrinsics.set_focal_x_px(camera.intrinsics.focal_px.x);
  intrinsics.set_focal_y_px(camera.intrinsics.focal_px.y);
  intrinsics.set_principal_x_px(camera.intrinsics.principal_px.x);
  intrinsics.set_principal_y_px(camera.intrinsics.principal_px.y);
}

void addPlane(v1::Layer& layer, v1::PlaneKind kind, v1::PlaneEncoding encoding, SizePx size_px,
              SharedBytes bytes, WireFrame& frame) {
  v1::Plane& plane = *layer.add_planes();
  plane.set_kind(kind);
  plane.set_encoding(encoding);
  plane.mutable_size()->set_width(size_px.width);
  plane.mutable_size()->set_height(size_px.height);
  plane.set_bytes_count(bytes->size());
  if (kind == v1::PLANE_KIND_DEPTH) {
    plane.mutable_depth()->set_meaning(v1::DEPTH_MEANING_PLANAR);
  }
  frame.planes.push_back(std::move(bytes));
}

SharedBytes bytesOf(const std::vector<float>& samples) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(samples.data());
  return std::make_shared<const std::vector<uint8_t>>(bytes,
                                                      bytes + samples.size() * sizeof(float));
}

}  // namespace

std::vector<WireFrame> makeSyntheticLoop(SizePx size_px, uint32_t layer_count,
                                         uint32_t frame_count) {
  std::vector<WireFrame> loop;
  for (uint32_t i = 0; i < frame_count; ++i) {
    const std::vector<SyntheticLayer> layers = renderSyntheticFrame(
        {.size_px = size_px, .layer_count = layer_count, .time_s = i * kFrameTimeS, .camera = {}});
    WireFrame& frame = loop.emplace_back();
    v1::Source& source = *frame.header.add_sources();
    declareCamera(syntheticCamera(size_px), *source.mutable_camera());
    for (const SyntheticLayer& rendered : layers) {
      v1::Layer& layer = *source.add_layers();
      addPlane(layer, v1::PLANE_KIND_COLOR, v1::PLANE_ENCODING_RGBA8, size_px,
               std::make_shared<const std::vector<uint8_t>>(rendered.color), frame);
      addPlane(layer, v1::PLANE_KIND_DEPTH, v1::PLANE_ENCODING_DEPTH_F32, size_px,
               bytesOf(rendered.depth_m), frame);
    }
  }
  return loop;
}

}  // namespace viewloom::load
