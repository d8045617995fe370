// SPDX-License-Identifier: Apache-2.0
// How far the colour of a sample is averaged (shaders/color.md, Means).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace viewloom {

// The mean goes so far beyond the sample's own px, to both sides along each axis of the source, px.
// 0: it is the sample alone.
struct ColorReach {
  float x_px = 0;
  float y_px = 0;

  bool isNone() const { return !(x_px > 0) && !(y_px > 0); }
  bool operator==(const ColorReach&) const = default;
};

// Samples that a reach takes in, whole or in part, to each side.
inline uint32_t tapCount(float reach_px) {
  return uint32_t(std::ceil(reach_px));
}

// What the one that is `tap` px away counts, 0..1.
inline float tapWeight(float reach_px, uint32_t tap) {
  return std::clamp(reach_px + 1 - float(tap), 0.0F, 1.0F);
}

}  // namespace viewloom
