// SPDX-License-Identifier: Apache-2.0
#include "base/light_of_codes.h"

#include <cmath>

namespace viewloom {
namespace {

float lightOfCode(int code) {
  const double srgb = code / 255.0;
  return float(srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4));
}

}  // namespace

const std::array<float, 256>& lightOfCodes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> light;
    for (int code = 0; code < 256; ++code) light[size_t(code)] = lightOfCode(code);
    return light;
  }();
  return table;
}

}  // namespace viewloom
