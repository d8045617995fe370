// SPDX-License-Identifier: Apache-2.0
// Blends of 8-bit sRGB, in arithmetic that compilers turn into vectors.
#pragma once

#include <cstdint>

namespace viewloom::bench {

inline constexpr uint32_t kOpaqueCode = 0xff000000U;

// By value, unlike std::clamp: a reference keeps a loop from vectors.
inline float clampTo(float value, float least, float most) {
  const float above = value < least ? least : value;
  return above > most ? most : above;
}

inline float codeAt(uint32_t color, uint32_t shift) {
  return float(int(color >> shift & 255U));
}

// Blend of the channel at `shift`.
inline uint32_t blendChannel(uint32_t a, uint32_t b, float weight, uint32_t shift) {
  const float code_a = codeAt(a, shift);
  const float code_b = codeAt(b, shift);
  return uint32_t(int(code_a + weight * (code_b - code_a) + 0.5F)) << shift;
}
// `weight` of b, the rest of a, as viewloom blends opaque colour; red in the low byte.
inline uint32_t blendCodes(uint32_t a, uint32_t b, float weight) {
  return kOpaqueCode | blendChannel(a, b, weight, 0) | blendChannel(a, b, weight, 8) |
         blendChannel(a, b, weight, 16);
}

// 0xRRGGBB, as a display's background is given, with red in the low byte.
inline uint32_t packBackground(uint32_t rgb) {
  return kOpaqueCode | (rgb >> 16 & 255U) | (rgb & 0xff00U) | (rgb & 255U) << 16;
}

}  // namespace viewloom::bench
