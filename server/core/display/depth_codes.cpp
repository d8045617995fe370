// SPDX-License-Identifier: Apache-2.0
#include "display/depth_codes.h"

namespace viewloom {

abi::DepthScale scaleOf(const DepthCodes& codes) {
  const double zero = codes.is_black_near ? codes.inv_z_near : codes.inv_z_far;
  const double full = codes.is_black_near ? codes.inv_z_far : codes.inv_z_near;
  return {.inv_z_of_zero = float(zero),
          .codes_per_inv_z = float(codes.codeMax() / (full - zero)),
          .code_max = float(codes.codeMax())};
}

}  // namespace viewloom
