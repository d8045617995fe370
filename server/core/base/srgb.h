// SPDX-License-Identifier: Apache-2.0
// The sRGB transfer curve (IEC 61966-2-1), for one channel.
//
// Two more forms of it are for many px at once and within a fraction of a code of this one:
// shaders/lib/light/srgb.glsl for kernels, server/engine/walk/lens/block_light_inl.h for vectors of
// the CPU.
#pragma once

#include <cmath>

namespace viewloom {

// Linear light, 1 = white, of an encoded value, 1 = white.
inline double linearFromSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}
inline double srgbFromLinear(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

}  // namespace viewloom
