// SPDX-License-Identifier: Apache-2.0
// Logarithmic bins over 2^-40 .. 2^24: a few bits of mantissa below the exponent of a float.
#ifndef VIEWLOOM_LIB_HISTOGRAM_GLSL_
#define VIEWLOOM_LIB_HISTOGRAM_GLSL_

#include "shared/structure_abi.h"

const uint kDepthMantissaBits = 5u;
const uint kNoiseMantissaBits = 4u;
const uint kLeastExponent = 127u - 40u;

uint logBin(float value, uint mantissa_bits, uint bin_count) {
  const int bin =
      int(floatBitsToUint(value) >> (23u - mantissa_bits)) - int(kLeastExponent << mantissa_bits);
  return uint(clamp(bin, 0, int(bin_count) - 1));
}

float binStart(uint bin, uint mantissa_bits) {
  return bin == 0u
             ? 0.0
             : uintBitsToFloat((bin + (kLeastExponent << mantissa_bits)) << (23u - mantissa_bits));
}

uint depthBin(float inv_z) {
  return logBin(inv_z, kDepthMantissaBits, kDepthHistogramBinCount);
}

// Bin 0 also holds 0.
uint noiseBin(float difference) {
  return logBin(difference, kNoiseMantissaBits, kNoiseHistogramBinCount);
}

#endif  // VIEWLOOM_LIB_HISTOGRAM_GLSL_
