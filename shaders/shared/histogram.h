// SPDX-License-Identifier: Apache-2.0
// What a source's depth and noise are measured with: logarithmic bins over 2^-40 .. 2^24, a few
// bits of mantissa below the exponent of a float; and how its connection tolerance follows.
#ifndef VIEWLOOM_SHADERS_SHARED_HISTOGRAM_H_
#define VIEWLOOM_SHADERS_SHARED_HISTOGRAM_H_

#include "shared/structure_abi.h"

VIEWLOOM_ABI_BEGIN

VIEWLOOM_ABI_CONST uint kDepthMantissaBits = 5u;
VIEWLOOM_ABI_CONST uint kNoiseMantissaBits = 4u;
VIEWLOOM_ABI_CONST uint kLeastExponent = 127u - 40u;

// Differences of a few roundings are none: 8 ulp, as a share of inv_z.
VIEWLOOM_ABI_CONST float kRoundingShare = 8.0f / 8388608.0f;

// kappa of a source that does not state its own (see shaders/README.md, Links).
VIEWLOOM_ABI_CONST float kKappaSteps = 1.5f;
VIEWLOOM_ABI_CONST float kKappaSigmas = 8.0f;
// A surface is one up to where neighbours differ by a fiftieth of their depth: at a focal length of
// 1000 px, up to 87 degrees from the image plane. Limbs of smooth bodies are as steep as that.
VIEWLOOM_ABI_CONST float kKappaRelative = 0.02f;
// |second difference| of independent noise: sigma sqrt(1 + 4 + 1), and a median of 0.6745 of that.
VIEWLOOM_ABI_CONST float kMedianPerSigma = 0.6745f * 2.44949f;
// Among differences that are not zero, a quantised source has none below its step.
VIEWLOOM_ABI_CONST float kStepQuantile = 0.01f;
// Percentiles of inv_z that stand for the near and the far of a source.
VIEWLOOM_ABI_CONST float kFarQuantile = 0.02f;
VIEWLOOM_ABI_CONST float kNearQuantile = 0.98f;

VIEWLOOM_ABI_FUNCTION uint logBin(float value, uint mantissa_bits, uint bin_count) {
  const int bin =
      int(floatBitsToUint(value) >> (23u - mantissa_bits)) - int(kLeastExponent << mantissa_bits);
  return bin < 0 ? 0u : uint(bin) < bin_count ? uint(bin) : bin_count - 1u;
}

VIEWLOOM_ABI_FUNCTION float binStart(uint bin, uint mantissa_bits) {
  return bin == 0u
             ? 0.0f
             : uintBitsToFloat((bin + (kLeastExponent << mantissa_bits)) << (23u - mantissa_bits));
}

VIEWLOOM_ABI_FUNCTION uint depthBin(float inv_z) {
  return logBin(inv_z, kDepthMantissaBits, kDepthHistogramBinCount);
}

// Bin 0 also holds 0.
VIEWLOOM_ABI_FUNCTION uint noiseBin(float difference) {
  return logBin(difference, kNoiseMantissaBits, kNoiseHistogramBinCount);
}

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_HISTOGRAM_H_
