// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_scenes.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace viewloom::bench {
namespace {

// Stripes that the colour fetch has something to interpolate on.
glm::vec3 striped(const glm::vec3& srgb, float u, float v) {
  return srgb * (0.8F + 0.2F * std::sin(90 * u + 30 * v) * std::sin(70 * v));
}

}  // namespace

WallPlane wallPlane(uint32_t depth) {
  const float further = 1 + 0.5F * float(depth);
  return {0.20F / further, 0.02F / further, 0.01F / further};
}

SceneSample wallAt(float u, float v, uint32_t depth) {
  const WallPlane plane = wallPlane(depth);
  return {plane.inv_z + plane.by_u * u + plane.by_v * v,
          striped({0.55F, 0.6F - 0.1F * float(depth), 0.7F}, u, v)};
}

SceneSample smoothAt(float u, float v) {
  const float ground = 0.15F + 0.4F * std::max(v - 0.55F, 0.0F);
  const float hills = 0.22F + 0.03F * std::sin(5 * u) * std::cos(4 * v);
  const bool is_ground = ground > hills;
  return {std::max(ground, hills),
          striped(is_ground ? glm::vec3{0.5F, 0.45F, 0.35F} : glm::vec3{0.35F, 0.6F, 0.3F}, u, v)};
}

bool Wire::covers(float at_u, float at_v) const {
  return std::abs(at_u - u - slope * (at_v - 0.5F)) <= half_width;
}

std::vector<Wire> makeWires() {
  constexpr int kWireCount = 160;
  constexpr float kWidth_px = 1920;
  std::mt19937 random(11);
  const auto uniform = [&](float low, float high) {
    return low + (high - low) * float(random() >> 8) / float(1 << 24);
  };
  std::vector<Wire> wires;
  for (int i = 0; i < kWireCount; ++i) {
    Wire wire{uniform(0, 1), uniform(-0.3F, 0.3F), uniform(0.5F, 1.5F) / kWidth_px,
              uniform(0.26F, 0.55F)};
    wire.srgb = {0.9F, 0.3F + wire.u / 2, 0.2F};
    wires.push_back(wire);
  }
  return wires;
}

}  // namespace viewloom::bench
