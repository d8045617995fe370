// SPDX-License-Identifier: Apache-2.0
// The sRGB transfer as IEC 61966-2-1 states it, for one channel of 0..1.
#pragma once

#include <cmath>

namespace viewloom {

inline double linearFrom(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

inline double srgbFrom(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace viewloom
