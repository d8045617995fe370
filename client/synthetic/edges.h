// SPDX-License-Identifier: Apache-2.0
// Texture edges that blend over the width of a pixel.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/vec2.hpp>

namespace viewloom::synthetic {

// A square wave of period 2: 1 on (0, 1), 0 on (1, 2), with slopes of half width `edge`.
inline float squareWave(float x, float edge) {
  const float triangle = std::abs(x - 2.0F * std::floor(x * 0.5F) - 1.0F);  // 1 at 0, 0 at 1
  const float from_edge = 0.5F - triangle;
  return std::clamp(0.5F + from_edge / (2.0F * edge), 0.0F, 1.0F);
}

inline float checker(glm::vec2 uv, float edge) {
  const float u = squareWave(uv.x + 0.5F, edge);
  const float v = squareWave(uv.y + 0.5F, edge);
  return u + v - 2.0F * u * v;
}

}  // namespace viewloom::synthetic
