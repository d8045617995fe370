// SPDX-License-Identifier: Apache-2.0
// What the depth codes of a display say: grey beside colour, for displays that make their own
// views.
#pragma once

#include <cstdint>

#include "shared/depth_scale.h"

namespace viewloom {

// Linear in 1/Z of the view, 1/m (proto DepthCodes).
struct DepthCodes {
  uint32_t bits = 8;           // 8 or 16
  double inv_z_near = 1;       // of the nearest code
  double inv_z_far = 0;        // of the farthest, less than that; negative: further than infinity
  bool is_black_near = false;  // else white is near

  uint32_t codeMax() const { return (1U << bits) - 1; }
};

// As what makes codes takes them.
abi::DepthScale scaleOf(const DepthCodes& codes);

}  // namespace viewloom
