// SPDX-License-Identifier: Apache-2.0
#include "support/truth/picture_frame.h"

#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include "base/check.h"
#include "frame/limits.h"
#include "support/srgb_transfer.h"

namespace viewloom::truth {
namespace {

SharedBytes srgbBytes(const std::vector<glm::vec3>& linear) {
  std::vector<uint8_t> bytes;
  bytes.reserve(4 * linear.size());
  for (const glm::vec3& color : linear) {
    for (int i = 0; i < 3; ++i) {
      bytes.push_back(static_cast<uint8_t>(std::lround(255 * srgbFrom(double{color[i]}))));
    }
    bytes.push_back(255);
  }
  return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
}

SharedBytes floatBytes(const std::vector<float>& samples) {
  std::vector<uint8_t> bytes(samples.size() * sizeof(float));
  std::memcpy(bytes.data(), samples.data(), bytes.size());
  return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
}

void addSource(const Picture& picture, uint32_t layer_count, Frame& frame) {
  VIEWLOOM_CHECK(layer_count >= 1 && layer_count <= picture.layers.size());
  SourceFormat& source = frame.format.sources.emplace_back();
  source.camera = picture.camera;
  std::vector<LayerPlanes>& planes = frame.sources.emplace_back();
  for (uint32_t i = 0; i < layer_count; ++i) {
    LayerFormat& layer = source.layers.emplace_back();
    layer.color = {.kind = PlaneKind::kColor, .size_px = picture.size_px};
    layer.depth = {.kind = PlaneKind::kDepth,
                   .encoding = PlaneEncoding::kDepthF32,
                   .size_px = picture.size_px};
    for (PlaneFormat* plane : {&layer.color, &layer.depth}) {
      plane->wire_bytes = uncompressedBytes(*plane);
    }
    planes.push_back({.color = srgbBytes(picture.layers[i].color),
                      .color_encoding = PlaneEncoding::kRgba8,
                      .depth = floatBytes(picture.layers[i].depth_m)});
  }
}

}  // namespace

FramePtr frameOf(const Picture& picture, uint32_t layer_count) {
  return frameOf(std::vector<Picture>{picture}, layer_count);
}

FramePtr frameOf(const std::vector<Picture>& pictures, uint32_t layer_count) {
  auto frame = std::make_shared<Frame>();
  frame->format.number = 1;
  for (const Picture& picture : pictures) addSource(picture, layer_count, *frame);
  return frame;
}

}  // namespace viewloom::truth
