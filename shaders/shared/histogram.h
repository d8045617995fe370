// SPDX-License-Identifier: Apache-2.0
// Histograms of a source's depth and noise: logarithmic bins over 2^-40 .. 2^24, a few bits of
// mantissa below the exponent of a float. Also the connection tolerance that follows from them.
#ifndef VIEWLOOM_SHADERS_SHARED_HISTOGRAM_H_
#define VIEWLOOM_SHADERS_SHARED_HISTOGRAM_H_

#include "shared/quotient.h"
#include "shared/structure_abi.h"

VIEWLOOM_ABI_BEGIN

VIEWLOOM_ABI_CONST uint kDepthMantissaBits = 5u;
VIEWLOOM_ABI_CONST uint kNoiseMantissaBits = 4u;
VIEWLOOM_ABI_CONST uint kLeastExponent = 127u - 40u;

// Differences of a few roundings are none: 8 ulp, as a share of inv_z. Nothing else is a share of
// inv_z itself: that depends on where infinity lies (shaders/structure.md, Steps).
VIEWLOOM_ABI_CONST float kRoundingShare = 8.0f / 8388608.0f;

// kappa of a source that does not state its own (see shaders/structure.md, Links).
VIEWLOOM_ABI_CONST float kKappaSteps = 1.5f;
VIEWLOOM_ABI_CONST float kKappaSigmas = 8.0f;
// A surface is one up to where neighbours differ by a fiftieth of their distance from the base:
// limbs of smooth bodies are as steep as that.
VIEWLOOM_ABI_CONST float kKappaRelative = 0.02f;
// So far behind the far percentile lies the base of steps, as a share of the range.
VIEWLOOM_ABI_CONST float kBaseMargin = 1.0f / 3.0f;
// |second difference| of independent noise: sigma sqrt(1 + 4 + 1), and a median of 0.6745 of that.
VIEWLOOM_ABI_CONST float kMedianPerSigma = 0.6745f * 2.44949f;
// Among differences that are not zero, a quantised source has none below its step.
VIEWLOOM_ABI_CONST float kStepQuantile = 0.01f;
// Percentiles of inv_z that stand for the near and the far of a source.
VIEWLOOM_ABI_CONST float kFarQuantile = 0.02f;
VIEWLOOM_ABI_CONST float kNearQuantile = 0.98f;

// Coarse depth is smoothed (shaders/structure.md, Coarse depth). px of disparity between the far
// and the near percentile from the outermost eye of a wide cone. In a small source it is no more
// than this share of the width.
VIEWLOOM_ABI_CONST float kWideSpan_px = 190.0f;
VIEWLOOM_ABI_CONST float kWideSpanShare = 0.5f;
// Half a step shows when it moves a px by more than the default tolerance of 0.25 px.
VIEWLOOM_ABI_CONST float kShownSteps = kWideSpan_px / (2.0f * 0.25f);
// Depth of fewer steps in its range, or of more noise, is none: flat things one behind the other
// step, too.
VIEWLOOM_ABI_CONST float kFewestSteps = 16.0f;
// Share of the places where depth changes from px to px that have to bend. Gentle slopes that are
// rounded bend almost everywhere, steep ones at half of their px. Exact slopes bend only at their
// creases and ends.
VIEWLOOM_ABI_CONST float kBentShare = 0.2f;
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

// The bin of the range histogram; the number of bins outside of the range.
VIEWLOOM_ABI_FUNCTION uint rangeBin(float inv_z, RangeBounds range) {
  const float place = (inv_z - range.begin) * range.bins_per_inv_z;
  const bool is_inside = place >= 0.0f && place <= float(kRangeHistogramBinCount);
  const uint last = kRangeHistogramBinCount - 1u;
  return !is_inside ? kRangeHistogramBinCount : uint(place) < last ? uint(place) : last;
}

// From the bin that holds the far percentile to that of the near one. An offset of all inv_z makes
// bins of the depth histogram coarse; those of the range histogram stay as fine as the range.
VIEWLOOM_ABI_FUNCTION RangeBounds rangeBounds(uint far_bin, uint near_bin, uint below_count,
                                              uint surface_count) {
  RangeBounds range;
  range.begin = binStart(far_bin, kDepthMantissaBits);
  const float width = binStart(near_bin + 1u, kDepthMantissaBits) - range.begin;
  range.bins_per_inv_z =
      surface_count == 0u ? 0.0f : exactQuotient(float(kRangeHistogramBinCount), width);
  range.below_count = below_count;
  range.surface_count = surface_count;
  return range;
}

// Bin 0 also holds 0.
VIEWLOOM_ABI_FUNCTION uint noiseBin(float difference) {
  return logBin(difference, kNoiseMantissaBits, kNoiseHistogramBinCount);
}

// inv_z that steps between surfaces are shares from: behind all but the furthest.
VIEWLOOM_ABI_FUNCTION float baseOfSteps(float inv_z_near, float inv_z_far) {
  VIEWLOOM_ABI_PRECISE const float margin = kBaseMargin * (inv_z_near - inv_z_far);
  VIEWLOOM_ABI_PRECISE const float base = inv_z_far - margin;
  return base;
}

// The least step of a rule that is a share of the distance from there: what is further is as far.
VIEWLOOM_ABI_FUNCTION float leastStep(float share, float inv_z_range) {
  return share * kBaseMargin * inv_z_range;
}

// Whether a difference of depths is no more than what a float rounds off.
VIEWLOOM_ABI_FUNCTION bool isLevel(float difference, float inv_z) {
  const float rounded = inv_z * kRoundingShare;
  return -rounded <= difference && difference <= rounded;
}

// The step that depth may be rounded to; 0 where it is too large for one, or where too few of the
// places where depth changes are bent.
VIEWLOOM_ABI_FUNCTION float stepOfDepth(float least_difference, float bent_count,
                                        float changing_count, float inv_z_range) {
  const bool is_step =
      kFewestSteps * least_difference <= inv_z_range && bent_count >= kBentShare * changing_count;
  return is_step ? least_difference : 0.0f;
}

// Whether depth is rounded to steps; not where exact surfaces merely end before others.
// `depth_step`: as of stepOfDepth; `step_median`: of differences that are not 0.
VIEWLOOM_ABI_FUNCTION bool isStepped(float depth_step, float step_median) {
  return depth_step > 0.0f && step_median <= kStepsMedian * depth_step;
}

// Noise shows when its sigma moves a px by more than one. Where a picture is small, even smooth
// surfaces bend by much of the range from px to px, and no eye is that far away.
VIEWLOOM_ABI_FUNCTION bool isNoiseShown(float noise_sigma, float inv_z_range, uint width_px) {
  const float in_proportion_px = kWideSpanShare * float(width_px);
  const float span_px = in_proportion_px < kWideSpan_px ? in_proportion_px : kWideSpan_px;
  return span_px * noise_sigma > inv_z_range;
}

// How far smoothing may move a sample, 1/m; 0 = it does not. `depth_step` as of stepOfDepth,
// `width_px` of the source.
VIEWLOOM_ABI_FUNCTION float smoothingReach(float depth_step, float step_median, float noise_sigma,
                                           float inv_z_range, uint width_px) {
  if (isStepped(depth_step, step_median))
    return kShownSteps * depth_step > inv_z_range ? 0.5f * depth_step : 0.0f;
  const bool is_noisy = noise_sigma > kStepsOfNoise * depth_step &&
                        kFewestSteps * noise_sigma <= inv_z_range &&
                        isNoiseShown(noise_sigma, inv_z_range, width_px);
  return is_noisy ? 2.0f * noise_sigma : 0.0f;
}

// Noise has no plateaus: the passes that span them are left out.
VIEWLOOM_ABI_FUNCTION uint firstSmoothingPass(float depth_step, float noise_sigma) {
  return noise_sigma > kStepsOfNoise * depth_step ? kFirstShortPass : 0u;
}

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_HISTOGRAM_H_
