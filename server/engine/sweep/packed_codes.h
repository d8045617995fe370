// SPDX-License-Identifier: Apache-2.0
// Opaque colour as a sweep blends it: codes of sRGB, 0..255, in 32 bits.
#pragma once

#include <cstdint>

namespace viewloom {

// Red, green and blue, of 11, 11 and 10 bits. Every code of 8 bits survives, and a blend of two
// rows is at most 1/16 (blue: 1/8) of a code off.
inline constexpr int kGreenShift = 11;
inline constexpr int kBlueShift = 22;
inline constexpr uint32_t kRedMask = 2047;
inline constexpr uint32_t kGreenMask = 2047;
inline constexpr uint32_t kBlueMask = 1023;
inline constexpr float kRedSteps = 8;  // a code
inline constexpr float kGreenSteps = 8;
inline constexpr float kBlueSteps = 4;

// `share` of b, the rest of a.
inline uint32_t blendOfCodes(uint32_t a, uint32_t b, float share) {
  const auto blend = [&](int shift, uint32_t mask) {
    const float from = float(a >> shift & mask);
    const float to = float(b >> shift & mask);
    return uint32_t(from + share * (to - from) + 0.5F) << shift;
  };
  return blend(0, kRedMask) | blend(kGreenShift, kGreenMask) | blend(kBlueShift, kBlueMask);
}

}  // namespace viewloom
