// SPDX-License-Identifier: Apache-2.0
#include "support/truth/picture_frame.h"

#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include <glm/gtc/packing.hpp>

#include "base/check.h"
#include "decode/keep_motion.h"
#include "decode/pack_surface.h"
#include "frame/cube_map.h"
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

// Bytes of three binary16 each.
SharedBytes halfBytes(const std::vector<glm::vec3>& vectors) {
  std::vector<uint8_t> bytes;
  for (const glm::vec3& vector : vectors) {
    for (int i = 0; i < 3; ++i) {
      const uint16_t half = glm::packHalf1x16(vector[i]);
      bytes.push_back(static_cast<uint8_t>(half));
      bytes.push_back(static_cast<uint8_t>(half >> 8));
    }
  }
  return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
}

uint8_t codeOf(float value) {
  return static_cast<uint8_t>(std::lround(255 * value));
}

// How a layer mirrors, if it does, as a publisher would say it.
void addSurface(const std::vector<Picture>& stacked, uint32_t index, const Camera& camera,
                LayerFormat& layer, LayerPlanes& planes) {
  std::vector<glm::vec3> normal;
  std::vector<uint8_t> roughness, specular;
  bool mirrors = false;
  for (const Picture& picture : stacked) {
    const PictureLayer& from = picture.layers[index];
    normal.insert(normal.end(), from.normal.begin(), from.normal.end());
    for (const Gloss& gloss : from.gloss) {
      roughness.push_back(codeOf(gloss.roughness));
      for (int c = 0; c < 3; ++c) specular.push_back(codeOf(gloss.light[c]));
      specular.push_back(255);
      mirrors = mirrors || gloss.mirrors();
    }
  }
  if (!mirrors) return;
  const SizePx size_px = layer.depth.size_px;
  layer.others = {{.kind = PlaneKind::kNormal,
                   .encoding = PlaneEncoding::kXyz16f,
                   .size_px = size_px,
                   .depth = {},
                   .normal_space = NormalSpace::kWorld},
                  {.kind = PlaneKind::kRoughness,
                   .encoding = PlaneEncoding::kR8,
                   .size_px = size_px,
                   .depth = {}},
                  {.kind = PlaneKind::kSpecular, .size_px = size_px, .depth = {}}};
  const auto shared = [](std::vector<uint8_t>& bytes) {
    return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
  };
  BytePool pool(0);
  viewloom::addSurface(
      layer,
      {.normal = halfBytes(normal), .roughness = shared(roughness), .specular = shared(specular)},
      camera.pose.orientation, pool, planes);
}

// How a layer's surfaces move, if any does.
void addMotion(const std::vector<Picture>& stacked, uint32_t index, LayerFormat& layer,
               LayerPlanes& planes) {
  std::vector<glm::vec3> motion_mps;
  for (const Picture& picture : stacked) {
    const std::vector<glm::vec3>& from = picture.layers[index].motion_mps;
    motion_mps.insert(motion_mps.end(), from.begin(), from.end());
  }
  BytePool pool(0);
  keepMotion(halfBytes(motion_mps), pool, planes);
  if (planes.motion == nullptr) return;
  layer.others.push_back({.kind = PlaneKind::kMotion,
                          .encoding = PlaneEncoding::kXyz16f,
                          .size_px = layer.depth.size_px,
                          .depth = {}});
}

// The first layers of pictures of one size, one below the other.
void addSource(const std::vector<Picture>& stacked, const Camera& camera, uint32_t layer_count,
               Frame& frame) {
  const Picture& first = stacked.front();
  VIEWLOOM_CHECK(layer_count >= 1 && layer_count <= first.layers.size());
  const SizePx size_px{first.size_px.width,
                       static_cast<uint32_t>(stacked.size()) * first.size_px.height};
  SourceFormat& source = frame.format.sources.emplace_back();
  source.camera = camera;
  std::vector<LayerPlanes>& planes = frame.sources.emplace_back();
  for (uint32_t i = 0; i < layer_count; ++i) {
    LayerFormat& layer = source.layers.emplace_back();
    layer.color = {.kind = PlaneKind::kColor, .size_px = size_px};
    layer.depth = {
        .kind = PlaneKind::kDepth, .encoding = PlaneEncoding::kDepthF32, .size_px = size_px};
    for (PlaneFormat* plane : {&layer.color, &layer.depth}) {
      plane->wire_bytes = uncompressedBytes(*plane);
    }
    std::vector<glm::vec3> color;
    std::vector<float> depth_m;
    for (const Picture& picture : stacked) {
      const PictureLayer& from = picture.layers[i];
      color.insert(color.end(), from.color.begin(), from.color.end());
      depth_m.insert(depth_m.end(), from.depth_m.begin(), from.depth_m.end());
    }
    planes.push_back({.color = srgbBytes(color),
                      .color_encoding = PlaneEncoding::kRgba8,
                      .depth = floatBytes(depth_m)});
    addSurface(stacked, i, camera, layer, planes.back());
    addMotion(stacked, i, layer, planes.back());
    for (PlaneFormat& plane : layer.others) plane.wire_bytes = uncompressedBytes(plane);
  }
}

}  // namespace

FramePtr frameOf(const Picture& picture, uint32_t layer_count) {
  return frameOf(std::vector<Picture>{picture}, layer_count);
}

FramePtr frameOf(const std::vector<Picture>& pictures, uint32_t layer_count) {
  auto frame = std::make_shared<Frame>();
  frame->format.number = 1;
  for (const Picture& picture : pictures) addSource({picture}, picture.camera, layer_count, *frame);
  return frame;
}

FramePtr cubeFrameOf(const std::vector<Picture>& faces, const Pose& cube, uint32_t layer_count) {
  VIEWLOOM_CHECK(faces.size() == kCubeFaceCount);
  auto frame = std::make_shared<Frame>();
  frame->format.number = 1;
  const Camera camera{.pose = cube, .intrinsics = cubeFaceIntrinsics(faces.front().size_px.width)};
  addSource(faces, camera, layer_count, *frame);
  frame->format.sources.front().is_cube_map = true;
  return frame;
}

}  // namespace viewloom::truth
