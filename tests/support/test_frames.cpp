// SPDX-License-Identifier: Apache-2.0
#include "support/test_frames.h"

#include <cstring>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "base/check.h"
#include "frame/cube_map.h"

namespace viewloom::test {
namespace {

SharedBytes floatBytes(const std::vector<float>& samples) {
  std::vector<uint8_t> bytes(samples.size() * sizeof(float));
  std::memcpy(bytes.data(), samples.data(), bytes.size());
  return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
}

LayerFormat layerFormat(SizePx size_px) {
  LayerFormat layer;
  layer.color.size_px = size_px;
  layer.depth.kind = PlaneKind::kDepth;
  layer.depth.encoding = PlaneEncoding::kDepthF32;
  layer.depth.size_px = size_px;
  return layer;
}

std::shared_ptr<Frame> emptyFrame(uint64_t number) {
  auto frame = std::make_shared<Frame>();
  frame->format.number = number;
  frame->format.capture_time_ns = static_cast<int64_t>(1000 * number);
  return frame;
}

void addLayers(SizePx size_px, std::vector<SyntheticLayer> layers, SourceFormat& source,
               Frame& frame) {
  std::vector<LayerPlanes>& planes = frame.sources.emplace_back();
  for (SyntheticLayer& layer : layers) {
    source.layers.push_back(layerFormat(size_px));
    planes.push_back({.color = std::make_shared<const std::vector<uint8_t>>(std::move(layer.color)),
                      .color_encoding = PlaneEncoding::kRgba8,
                      .depth = floatBytes(layer.depth_m)});
  }
}

void addSource(const SyntheticOptions& options, Frame& frame) {
  SourceFormat& source = frame.format.sources.emplace_back();
  source.camera = options.camera.value_or(syntheticCamera(options.size_px));
  addLayers(options.size_px, renderSyntheticFrame(options), source, frame);
}

}  // namespace

FramePtr layeredFrame(uint64_t number, const Camera& camera, SizePx size_px,
                      std::vector<SyntheticLayer> layers, double connection_tolerance) {
  const std::shared_ptr<Frame> frame = emptyFrame(number);
  SourceFormat& source = frame->format.sources.emplace_back();
  source.camera = camera;
  source.connection_tolerance = connection_tolerance;
  addLayers(size_px, std::move(layers), source, *frame);
  return frame;
}

FramePtr syntheticFrame(uint64_t number, SizePx size_px, uint32_t layer_count, double time_s) {
  const std::shared_ptr<Frame> frame = emptyFrame(number);
  addSource({.size_px = size_px,
             .layer_count = layer_count,
             .time_s = time_s,
             .camera = {},
             .thread_count = 1},
            *frame);
  return frame;
}

FramePtr movedFrame(const Frame& frame, uint64_t number) {
  auto moved = std::make_shared<Frame>(frame);
  moved->format.number = number;
  moved->format.sources[0].camera.pose.position_m.x = 0.001 * static_cast<double>(number);
  return moved;
}

FramePtr syntheticFrameFrom(uint64_t number, const std::vector<double>& places_m, SizePx size_px) {
  const std::shared_ptr<Frame> frame = emptyFrame(number);
  for (const double place_m : places_m) {
    Camera camera = syntheticCamera(size_px);
    camera.pose.position_m.x = place_m;
    addSource({.size_px = size_px, .layer_count = 1, .camera = camera, .thread_count = 1}, *frame);
  }
  return frame;
}

FramePtr syntheticCubeFrame(uint64_t number, uint32_t side_px) {
  const std::shared_ptr<Frame> frame = emptyFrame(number);
  const SizePx size_px{side_px, kCubeFaceCount * side_px};
  SourceFormat& source = frame->format.sources.emplace_back();
  source.camera.intrinsics = cubeFaceIntrinsics(side_px);
  source.is_cube_map = true;
  std::vector<SyntheticLayer> stacked(2);
  for (uint32_t face = 0; face < kCubeFaceCount; ++face) {
    const auto layers = renderSyntheticFrame({.size_px = {side_px, side_px},
                                              .layer_count = 2,
                                              .camera = cubeFaceCamera({}, face, side_px),
                                              .thread_count = 1});
    for (size_t i = 0; i < stacked.size(); ++i) {
      const SyntheticLayer& from = layers[i];
      stacked[i].color.insert(stacked[i].color.end(), from.color.begin(), from.color.end());
      stacked[i].depth_m.insert(stacked[i].depth_m.end(), from.depth_m.begin(), from.depth_m.end());
    }
  }
  addLayers(size_px, std::move(stacked), source, *frame);
  return frame;
}

DisplaySpec smallQuilt(SizePx size_px) {
  QuiltSpec quilt;
  quilt.columns = 4;
  quilt.rows = 2;
  quilt.size_px = size_px;
  DisplaySpec spec;
  spec.kind = quilt;
  absl::StatusOr<DisplaySpec> complete = completeDisplaySpec(spec);
  VIEWLOOM_CHECK(complete.ok());
  return *complete;
}

DisplaySpec turnedCamera() {
  DisplaySpec spec;
  ViewCamera camera;
  camera.pose.orientation = glm::angleAxis(0.1, glm::dvec3(0, 0, 1));
  camera.projection = Intrinsics{.focal_px = {100, 100}, .principal_px = {80, 45}};
  spec.kind = CamerasSpec{.cameras = {camera}, .tile_size_px = {160, 90}, .columns = 1};
  return spec;
}

}  // namespace viewloom::test
