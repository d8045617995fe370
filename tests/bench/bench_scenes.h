// SPDX-License-Identifier: Apache-2.0
// The scenes that loads are made of, as functions of the source's image: u to the right, v down,
// 0..1 in the image.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "bench/bench_load.h"

namespace viewloom::bench {

// Sample of a layer at a place.
struct SceneSample {
  float inv_z = kNoSurface;  // 1/m
  glm::vec3 srgb{0.0F};
};

// A wall that leans a little; deeper ones stand further back. Linear in u and v.
struct WallPlane {
  float inv_z, by_u, by_v;
};
WallPlane wallPlane(uint32_t depth);
SceneSample wallAt(float u, float v, uint32_t depth);

// Ground and gentle hills. Its inv_z changes so little across the image that each ray meets it
// once: by less than kSmoothSlopeMax for each u or v of 1.
inline constexpr float kSmoothSlopeMax = 0.5F;
SceneSample smoothAt(float u, float v);

// A strip of one depth, nearer than any wall, one to three px of 1920 wide.
struct Wire {
  float u, slope, half_width, inv_z;
  glm::vec3 srgb{0.0F};

  bool covers(float at_u, float at_v) const;
};
std::vector<Wire> makeWires();

}  // namespace viewloom::bench
