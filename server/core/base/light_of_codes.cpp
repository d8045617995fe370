// SPDX-License-Identifier: Apache-2.0
#include "base/light_of_codes.h"

#include "base/srgb.h"

namespace viewloom {

const std::array<float, 256>& lightOfCodes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> light;
    for (int code = 0; code < 256; ++code)
      light[size_t(code)] = float(linearFromSrgb(code / 255.0));
    return light;
  }();
  return table;
}

}  // namespace viewloom
