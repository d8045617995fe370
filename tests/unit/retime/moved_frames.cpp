// SPDX-License-Identifier: Apache-2.0
#include "unit/retime/moved_frames.h"

#include <cstring>
#include <memory>
#include <utility>

#include <glm/gtc/packing.hpp>

namespace viewloom::test {
namespace {

template <typename T>
void append(const T& value, std::vector<uint8_t>& bytes) {
  const size_t end = bytes.size();
  bytes.resize(end + sizeof value);
  std::memcpy(bytes.data() + end, &value, sizeof value);
}

SharedBytes shared(std::vector<uint8_t> bytes) {
  return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
}

LayerPlanes planesOf(const MovingLayer& layer, SizePx size_px) {
  std::vector<uint8_t> color, depth, motion;
  bool moves = false;
  for (uint32_t y = 0; y < size_px.height; ++y) {
    for (uint32_t x = 0; x < size_px.width; ++x) {
      const MovingPx px = layer(x, y);
      for (int i = 0; i < 3; ++i) color.push_back(px.color[i]);
      color.push_back(255);
      append(px.inv_z, depth);
      for (int i = 0; i < 3; ++i) append(glm::packHalf1x16(px.motion_mps[i]), motion);
      moves = moves || px.motion_mps != glm::vec3(0);
    }
  }
  LayerPlanes planes{.color = shared(std::move(color)), .depth = shared(std::move(depth))};
  if (moves) planes.motion = shared(std::move(motion));
  return planes;
}

size_t indexOf(uint32_t x, uint32_t y) {
  return size_t{y} * kMovedPx.width + x;
}

}  // namespace

Camera movedCamera() {
  return {.pose = {},
          .intrinsics = {.focal_px = glm::dvec2(kMovedFocal_px),
                         .principal_px = {0.5 * kMovedPx.width, 0.5 * kMovedPx.height}}};
}

FramePtr movingFrame(const std::vector<MovingLayer>& layers, double connection_tolerance,
                     const Pose& pose, SizePx size_px) {
  auto frame = std::make_shared<Frame>();
  frame->format.number = 1;
  SourceFormat& source = frame->format.sources.emplace_back();
  source.camera = movedCamera();
  source.camera.pose = pose;
  source.connection_tolerance = connection_tolerance;
  frame->sources.emplace_back();
  for (const MovingLayer& layer : layers) {
    LayerFormat& format = source.layers.emplace_back();
    format.color.size_px = size_px;
    format.depth = {.kind = PlaneKind::kDepth,
                    .encoding = PlaneEncoding::kDepthF32,
                    .size_px = size_px,
                    .depth = {.meaning = DepthMeaning::kDisparity, .invalid_value = -1}};
    frame->sources.front().push_back(planesOf(layer, size_px));
  }
  return frame;
}

float invZAt(const Frame& frame, uint32_t layer, uint32_t x, uint32_t y) {
  float inv_z = 0;
  std::memcpy(&inv_z, frame.sources[0][layer].depth->data() + 4 * indexOf(x, y), sizeof inv_z);
  return inv_z;
}

glm::u8vec3 colorAt(const Frame& frame, uint32_t layer, uint32_t x, uint32_t y) {
  const uint8_t* const texel = frame.sources[0][layer].color->data() + 4 * indexOf(x, y);
  return {texel[0], texel[1], texel[2]};
}

glm::u8vec3 colorOfPx(uint32_t x, uint32_t y, uint8_t blue) {
  return {7 * x, 10 * y, blue};
}

}  // namespace viewloom::test
