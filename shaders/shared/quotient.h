// SPDX-License-Identifier: Apache-2.0
// Quotients that are the same on every device. Vulkan allows a division 2.5 ulp of error, and its
// fma() need not be fused, so neither serves where the device, the sweep and the oracle have to
// agree to the bit.
#ifndef VIEWLOOM_SHADERS_SHARED_QUOTIENT_H_
#define VIEWLOOM_SHADERS_SHARED_QUOTIENT_H_

#include "shared/gpu_types.h"

VIEWLOOM_ABI_BEGIN

VIEWLOOM_ABI_CONST uint kMantissaBits = 23u;
VIEWLOOM_ABI_CONST uint kHiddenBit = 1u << kMantissaBits;

// numerator / denominator, rounded to nearest, by long division of their mantissas. The numerator
// may be 0; otherwise both are positive, and they and the quotient are normal numbers.
//
// Slower than a division by a hundred operations: for a few values, not for every sample.
VIEWLOOM_ABI_FUNCTION float exactQuotient(float numerator, float denominator) {
  const uint above = floatBitsToUint(numerator);
  const uint below = floatBitsToUint(denominator);
  const uint divisor = (below & (kHiddenBit - 1u)) | kHiddenBit;
  uint rest = (above & (kHiddenBit - 1u)) | kHiddenBit;
  uint exponent = (above >> kMantissaBits) + 127u - (below >> kMantissaBits);
  if (rest < divisor) {
    rest *= 2u;
    --exponent;
  }
  // All bits of the mantissa, and one by which it is rounded. There are no ties: in one, the last
  // bit is 1 and nothing rests, so that the divisor would be a multiple of 2^24.
  uint quotient = 0u;
  for (uint i = 0u; i < kMantissaBits + 2u; ++i) {
    const uint bit = rest >= divisor ? 1u : 0u;
    quotient = 2u * quotient + bit;
    rest = 2u * (rest - bit * divisor);
  }
  const uint rounded = (quotient + 1u) / 2u - kHiddenBit;  // may carry into the exponent
  return above == 0u ? 0.0f : uintBitsToFloat((exponent << kMantissaBits) + rounded);
}

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_QUOTIENT_H_
