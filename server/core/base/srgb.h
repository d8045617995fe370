// SPDX-License-Identifier: Apache-2.0
// The sRGB transfer curve (IEC 61966-2-1), for one channel.
//
// Two more forms of it are for many px at once and within a fraction of a code of this one:
// shaders/lib/light/srgb.glsl for kernels, server/engine/walk/lens/block_light_inl.h for vectors of
// the CPU.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace viewloom {

// Linear light, 1 = white, of an encoded value, 1 = white.
inline double linearFromSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}
inline double srgbFromLinear(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

// Linear light, 0..1, by codes of 8 bits.
inline const std::array<float, 256>& lightOfCodes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> light;
    for (int code = 0; code < 256; ++code)
      light[size_t(code)] = float(linearFromSrgb(code / 255.0));
    return light;
  }();
  return table;
}

}  // namespace viewloom
