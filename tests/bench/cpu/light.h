// SPDX-License-Identifier: Apache-2.0
// 8-bit sRGB to light and back, in arithmetic that compilers turn into vectors.
#pragma once

#include <cmath>
#include <cstdint>

namespace viewloom::bench {

inline constexpr uint32_t kOpaqueCode = 0xff000000U;

// By value, unlike std::clamp: a reference keeps a loop from vectors.
inline float clampTo(float value, float least, float most) {
  const float above = value < least ? least : value;
  return above > most ? most : above;
}

// As viewloom blends opaque colour (shaders/lib/srgb.glsl): a cubic of the code, and a cubic of the
// root of light. Codes survive unchanged, and a blend is less than two codes off that in linear
// light.
inline float lightFromCode(uint32_t code) {
  const float value = float(int(code));
  return ((2.4726537e-08F * value + 8.366013e-06F) * value + 1.8039216e-04F) * value;
}
inline uint32_t codeFromLight(float light) {
  const float root = std::sqrt(light + 0.00078F);
  return uint32_t(int(((33.135467F * root - 111.46330F) * root + 342.96448F) * root - 9.1227989F));
}

// Of the channel at `shift`.
inline uint32_t blendChannel(uint32_t a, uint32_t b, float weight, uint32_t shift) {
  const float light_a = lightFromCode((a >> shift) & 255U);
  const float light_b = lightFromCode((b >> shift) & 255U);
  return codeFromLight(light_a + weight * (light_b - light_a)) << shift;
}
// `weight` of b, the rest of a; red in the low byte.
inline uint32_t blendCodes(uint32_t a, uint32_t b, float weight) {
  return kOpaqueCode | blendChannel(a, b, weight, 0) | blendChannel(a, b, weight, 8) |
         blendChannel(a, b, weight, 16);
}

// 0xRRGGBB, as a display's background is given, with red in the low byte.
inline uint32_t packBackground(uint32_t rgb) {
  return kOpaqueCode | (rgb >> 16 & 255U) | (rgb & 0xff00U) | (rgb & 255U) << 16;
}

}  // namespace viewloom::bench
