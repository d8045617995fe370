// SPDX-License-Identifier: Apache-2.0
// Area over which the colour of a sample is averaged (shaders/color.md, Means).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace viewloom {

// Reach of the mean beyond the sample's own pixel, to both sides along each axis of the source, px.
// 0: only the sample itself.
struct ColorReach {
  float x_px = 0;
  float y_px = 0;

  bool isNone() const { return !(x_px > 0) && !(y_px > 0); }
  bool operator==(const ColorReach&) const = default;
};

// Number of samples to each side that a reach covers, whole or in part.
inline uint32_t tapCount(float reach_px) {
  return uint32_t(std::ceil(reach_px));
}

// Weight of the sample that is `tap` pixels away, 0..1.
inline float tapWeight(float reach_px, uint32_t tap) {
  return std::clamp(reach_px + 1 - float(tap), 0.0F, 1.0F);
}

}  // namespace viewloom
