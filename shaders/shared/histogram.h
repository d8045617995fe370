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

// What is coarse is smoothed (shaders/README.md, Coarse depth).
// px of disparity between infinity and the near percentile from the outermost eye of a wide cone.
VIEWLOOM_ABI_CONST float kWideSpan_px = 190.0f;
// Half a step shows when it moves a px by more than the default tolerance of 0.25 px.
VIEWLOOM_ABI_CONST float kShownSteps = kWideSpan_px / (2.0f * 0.25f);
// Noise shows when its sigma moves a px by more than one.
VIEWLOOM_ABI_CONST float kShownSigmas = kWideSpan_px;
// Depth of fewer steps, or of more noise, is none: flat things one behind the other step, too.
VIEWLOOM_ABI_CONST float kFewestSteps = 32.0f;
// Second differences of a surface that is rounded to steps are one or two steps, or 0: the median
// of those that are not 0 lies no higher than that, by a bin.
VIEWLOOM_ABI_CONST float kStepsMedian = 2.2f;
// Noise has a step as well, the least of its differences; its sigma is tens of these.
VIEWLOOM_ABI_CONST float kStepsOfNoise = 2.0f;

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

// The step that depth may be rounded to; 0 where it is too large for one.
VIEWLOOM_ABI_FUNCTION float stepOfDepth(float least_difference, float inv_z_near) {
  return kFewestSteps * least_difference <= inv_z_near ? least_difference : 0.0f;
}

// Whether depth is rounded to steps; not where exact surfaces merely end before others.
// `step_median`: of differences that are not 0.
VIEWLOOM_ABI_FUNCTION bool isStepped(float depth_step, float step_median, float inv_z_near) {
  const float step = stepOfDepth(depth_step, inv_z_near);
  return step > 0.0f && step_median <= kStepsMedian * step;
}

// How far smoothing may move a sample, 1/m; 0 = it does not. Arguments as of isStepped.
VIEWLOOM_ABI_FUNCTION float smoothingReach(float depth_step, float step_median, float noise_sigma,
                                           float inv_z_near) {
  const bool is_stepped = isStepped(depth_step, step_median, inv_z_near);
  if (is_stepped) return kShownSteps * depth_step > inv_z_near ? 0.5f * depth_step : 0.0f;
  const bool is_noisy = noise_sigma > kStepsOfNoise * depth_step &&
                        kFewestSteps * noise_sigma <= inv_z_near &&
                        kShownSigmas * noise_sigma > inv_z_near;
  return is_noisy ? 2.0f * noise_sigma : 0.0f;
}

// Noise has no plateaus: the passes that span them are left out.
VIEWLOOM_ABI_FUNCTION uint firstSmoothingPass(float depth_step, float noise_sigma) {
  return noise_sigma > kStepsOfNoise * depth_step ? kFirstShortPass : 0u;
}

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_HISTOGRAM_H_
