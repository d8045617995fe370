// SPDX-License-Identifier: Apache-2.0
// Colour as a sweep blends it: light that is nearly linear, by its root, in 32 bits.
#pragma once

#include <cstdint>

namespace viewloom {

// Light of a code (0..255) is the cubic of shaders/lib/srgb.glsl, 0..1 and a little; a blend of
// light is one of squared roots. Packed: the roots of red, green and blue, of 11, 11 and 10 bits.
// A code is at least 0.003 of a root wide, so that a code survives: half a step of 10 bits is 0.17
// of it, and the cubic back is within 0.14.
inline constexpr float kLightCubic[3] = {2.4726537e-08F, 8.366013e-06F, 1.8039216e-04F};
inline constexpr float kRootOffset = 0.00078F;  // of light, before the root is taken
inline constexpr float kCodeCubic[4] = {33.135467F, -111.46330F, 342.96448F, -9.6227989F};
inline constexpr float kRootMax = 1.0004F;  // of code 255, rounded up

inline constexpr uint32_t kRedSteps = 2047;
inline constexpr uint32_t kGreenSteps = 2047;
inline constexpr uint32_t kBlueSteps = 1023;
inline constexpr int kGreenShift = 11;
inline constexpr int kBlueShift = 22;

}  // namespace viewloom
