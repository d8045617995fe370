// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_frames.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "synthetic/synthetic_frame.h"

namespace viewloom::bench {
namespace {

constexpr float kNothing = -1;  // no surface

// What a layer shows at the centre of a px: u to the right, v down, 0..1.
struct Sample {
  float inv_z = kNothing;
  glm::vec3 srgb{0.0F};
};
using LayerFunction = std::function<Sample(float u, float v)>;

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
  layer.depth.depth = {.meaning = DepthMeaning::kDisparity, .invalid_value = double{kNothing}};
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
        const Sample sample = layer((float(x) + 0.5F) / float(size_px.width),
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

// Stripes that the colour fetch has something to interpolate on.
glm::vec3 striped(const glm::vec3& srgb, float u, float v) {
  return srgb * (0.8F + 0.2F * std::sin(90 * u + 30 * v) * std::sin(70 * v));
}

// A wall that leans a little; deeper ones stand further back.
Sample wall(float u, float v, uint32_t depth) {
  const float inv_z = (0.20F + 0.02F * u + 0.01F * v) / (1 + 0.5F * float(depth));
  return {inv_z, striped({0.55F, 0.6F - 0.1F * float(depth), 0.7F}, u, v)};
}

}  // namespace

FramePtr clutterFrame(SizePx size_px, uint32_t layer_count) {
  const std::shared_ptr<Frame> frame = emptyFrame(size_px);
  for (const SyntheticLayer& layer : renderSyntheticFrame(
           {.size_px = size_px, .layer_count = layer_count, .time_s = 0, .camera = {}})) {
    std::vector<float> inv_z;
    inv_z.reserve(layer.depth_m.size());
    for (const float depth_m : layer.depth_m) {
      inv_z.push_back(depth_m > 0 ? 1 / depth_m : kNothing);  // 1 / inf is the sky
    }
    addLayer(*frame, size_px, inv_z, layer.color);
  }
  return frame;
}

FramePtr smoothFrame(SizePx size_px, uint32_t layer_count) {
  const auto front = [](float u, float v) {
    const float ground = 0.15F + 0.4F * std::max(v - 0.55F, 0.0F);
    const float hills = 0.22F + 0.03F * std::sin(5 * u) * std::cos(4 * v);
    const bool is_ground = ground > hills;
    return Sample{
        std::max(ground, hills),
        striped(is_ground ? glm::vec3{0.5F, 0.45F, 0.35F} : glm::vec3{0.35F, 0.6F, 0.3F}, u, v)};
  };
  std::vector<LayerFunction> layers{front};
  for (uint32_t depth = 1; depth < layer_count; ++depth) {
    layers.emplace_back([depth](float u, float v) { return wall(u, v, depth); });
  }
  return frameOfFunctions(size_px, layers);
}

FramePtr thinFrame(SizePx size_px, uint32_t layer_count) {
  struct Wire {
    float u, slope, half_width, inv_z;
  };
  constexpr int kWireCount = 160;
  std::mt19937 random(11);
  const auto uniform = [&](float low, float high) {
    return low + (high - low) * float(random() >> 8) / float(1 << 24);
  };
  std::vector<Wire> wires;
  for (int i = 0; i < kWireCount; ++i) {
    wires.push_back({uniform(0, 1), uniform(-0.3F, 0.3F),
                     uniform(0.5F, 1.5F) / float(size_px.width), uniform(0.26F, 0.55F)});
  }
  const auto front = [wires](float u, float v) {
    Sample nearest = wall(u, v, 0);
    for (const Wire& wire : wires) {
      const bool covers = std::abs(u - wire.u - wire.slope * (v - 0.5F)) <= wire.half_width;
      if (covers && wire.inv_z > nearest.inv_z) {
        nearest = {wire.inv_z, glm::vec3{0.9F, 0.3F + wire.u / 2, 0.2F}};
      }
    }
    return nearest;
  };
  std::vector<LayerFunction> layers{front};
  for (uint32_t depth = 1; depth < layer_count; ++depth) {
    layers.emplace_back([front, depth](float u, float v) {
      const Sample behind = wall(u, v, 0);
      return depth == 1 && front(u, v).inv_z > behind.inv_z ? behind : Sample{};
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
