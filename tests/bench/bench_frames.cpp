// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_frames.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "bench/bench_scenes.h"
#include "synthetic/synthetic_frame.h"

namespace viewloom::bench {
namespace {

using LayerFunction = std::function<SceneSample(float u, float v)>;

SharedBytes bytesOf(const void* data, size_t size_bytes) {
  const auto* bytes = static_cast<const uint8_t*>(data);
  return std::make_shared<std::vector<uint8_t>>(bytes, bytes + size_bytes);
}

void addLayer(Frame& frame, SizePx size_px, const std::vector<float>& inv_z,
              const std::vector<uint8_t>& rgba) {
  LayerFormat layer;
  layer.color = {.kind = PlaneKind::kColor, .size_px = size_px};
  layer.depth = {
      .kind = PlaneKind::kDepth, .encoding = PlaneEncoding::kDepthF32, .size_px = size_px};
  layer.depth.depth = {.meaning = DepthMeaning::kDisparity, .invalid_value = double{kNoSurface}};
  frame.format.sources.front().layers.push_back(layer);
  frame.sources.front().push_back({.color = bytesOf(rgba.data(), rgba.size()),
                                   .depth = bytesOf(inv_z.data(), inv_z.size() * sizeof(float))});
}

std::shared_ptr<Frame> emptyFrame(SizePx size_px) {
  auto frame = std::make_shared<Frame>();
  frame->format.number = 1;
  frame->format.sources.emplace_back().camera = syntheticCamera(size_px);
  frame->sources.emplace_back();
  return frame;
}

FramePtr frameOfFunctions(SizePx size_px, const std::vector<LayerFunction>& layers) {
  const std::shared_ptr<Frame> frame = emptyFrame(size_px);
  for (const LayerFunction& layer : layers) {
    std::vector<float> inv_z;
    std::vector<uint8_t> rgba;
    for (uint32_t y = 0; y < size_px.height; ++y) {
      for (uint32_t x = 0; x < size_px.width; ++x) {
        const SceneSample sample = layer((float(x) + 0.5F) / float(size_px.width),
                                         (float(y) + 0.5F) / float(size_px.height));
        inv_z.push_back(sample.inv_z);
        for (int i = 0; i < 3; ++i) {
          rgba.push_back(uint8_t(std::lround(255 * std::clamp(sample.srgb[i], 0.0F, 1.0F))));
        }
        rgba.push_back(255);
      }
    }
    addLayer(*frame, size_px, inv_z, rgba);
  }
  return frame;
}

}  // namespace

FramePtr clutterFrame(SizePx size_px, uint32_t layer_count) {
  const std::shared_ptr<Frame> frame = emptyFrame(size_px);
  for (const SyntheticLayer& layer : renderSyntheticFrame(
           {.size_px = size_px, .layer_count = layer_count, .time_s = 0, .camera = {}})) {
    std::vector<float> inv_z;
    inv_z.reserve(layer.depth_m.size());
    for (const float depth_m : layer.depth_m) {
      inv_z.push_back(depth_m > 0 ? 1 / depth_m : kNoSurface);  // 1 / inf is the sky
    }
    addLayer(*frame, size_px, inv_z, layer.color);
  }
  return frame;
}

FramePtr smoothFrame(SizePx size_px, uint32_t layer_count) {
  std::vector<LayerFunction> layers{smoothAt};
  for (uint32_t depth = 1; depth < layer_count; ++depth) {
    layers.emplace_back([depth](float u, float v) { return wallAt(u, v, depth); });
  }
  return frameOfFunctions(size_px, layers);
}

FramePtr thinFrame(SizePx size_px, uint32_t layer_count) {
  const std::vector<Wire> wires = makeWires();
  const auto front = [wires](float u, float v) {
    SceneSample nearest = wallAt(u, v, 0);
    for (const Wire& wire : wires) {
      if (wire.covers(u, v) && wire.inv_z > nearest.inv_z) nearest = {wire.inv_z, wire.srgb};
    }
    return nearest;
  };
  std::vector<LayerFunction> layers{front};
  for (uint32_t depth = 1; depth < layer_count; ++depth) {
    layers.emplace_back([front, depth](float u, float v) {
      const SceneSample behind = wallAt(u, v, 0);
      return depth == 1 && front(u, v).inv_z > behind.inv_z ? behind : SceneSample{};
    });
  }
  return frameOfFunctions(size_px, layers);
}

FramePtr withNoise(const Frame& frame, double sigma_inv_z, uint32_t seed) {
  auto noisy = std::make_shared<Frame>(frame);
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, float(sigma_inv_z));
  for (LayerPlanes& planes : noisy->sources.front()) {
    std::vector<float> inv_z(planes.depth->size() / sizeof(float));
    std::memcpy(inv_z.data(), planes.depth->data(), planes.depth->size());
    for (float& value : inv_z) {
      if (value > 0) value = std::max(value + noise(random), 0.0F);
    }
    planes.depth = bytesOf(inv_z.data(), inv_z.size() * sizeof(float));
  }
  return noisy;
}

}  // namespace viewloom::bench
