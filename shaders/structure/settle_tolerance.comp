// SPDX-License-Identifier: Apache-2.0
// From the histograms: depth percentiles, quantisation step, noise, and the connection tolerance
// kappa. One invocation: a few passes over a few thousand counters.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/fault.glsl"
#include "lib/memory.glsl"
#include "shared/histogram.h"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { BuildPush push; };

// Within its bin as if samples were spread evenly.
float depthQuantile(MeasuredRef measured, float share) {
  const RangeBounds range = measured.value.head.range;
  precise const float wanted = share * float(range.surface_count);
  if (wanted <= float(measured.value.depth_histogram[0])) return 0.0;
  float below = float(range.below_count);
  for (uint bin = 0u; bin < kRangeHistogramBinCount; ++bin) {
    const float here = float(measured.value.range_histogram[bin]);
    if (here > 0.0 && below + here >= wanted) {
      const float place = float(bin) + exactQuotient(max(wanted - below, 0.0), here);
      return range.begin + exactQuotient(place, range.bins_per_inv_z);
    }
    below += here;
  }
  return range.begin + exactQuotient(float(kRangeHistogramBinCount), range.bins_per_inv_z);
}

// The end of the bin that holds the quantile, counted from bin `first`; without so many zeros.
float noiseQuantile(MeasuredRef measured, uint first, float zero_count, float share) {
  float total = -zero_count;
  for (uint bin = first; bin < kNoiseHistogramBinCount; ++bin) {
    total += float(measured.value.noise_histogram[bin]);
  }
  float below = -zero_count;
  for (uint bin = first; bin < kNoiseHistogramBinCount && total > 0.0; ++bin) {
    below += float(measured.value.noise_histogram[bin]);
    if (below >= share * total) return bin == 0u ? 0.0 : binStart(bin + 1u, kNoiseMantissaBits);
  }
  return 0.0;
}

float bentCount(MeasuredRef measured) {
  uint count = 0u;
  for (uint bin = 1u; bin < kNoiseHistogramBinCount; ++bin) {
    count += measured.value.noise_histogram[bin];
  }
  return float(count);
}

// Smoothing, where depth is so coarse that it shows.
float settleSmoothing(MeasuredRef measured, float depth_step, float inv_z_range) {
  const float step_median = noiseQuantile(measured, 1u, 0.0, 0.5);
  // The sky is neither rounded nor noisy.
  const float sky_count =
      min(float(measured.value.depth_histogram[0]), float(measured.value.noise_histogram[0]));
  const float noise_sigma =
      exactQuotient(noiseQuantile(measured, 0u, sky_count, 0.5), kMedianPerSigma);
  const float reach =
      smoothingReach(depth_step, step_median, noise_sigma, inv_z_range, push.width_px);
  const uint first_pass = firstSmoothingPass(depth_step, noise_sigma);
  const uint blocks_x = (push.width_px + uint(kBlockPx) - 1u) / uint(kBlockPx);
  const uvec3 groups = uvec3((blocks_x + kNodeGroupSize - 1u) / kNodeGroupSize,
                             (push.height_px + uint(kBlockPx) - 1u) / uint(kBlockPx),
                             1u);
  measured.value.head.smoothing_reach = reach;
  measured.value.head.first_smoothing_pass = first_pass;
  measured.value.head.long_groups = reach > 0.0 && first_pass == 0u ? groups : uvec3(0u);
  measured.value.head.short_groups = reach > 0.0 ? groups : uvec3(0u);
  return reach > 0.0 && first_pass > 0u ? noise_sigma : 0.0;
}

void main() {
  MeasuredRef measured = MeasuredRef(push.measured);
  const float inv_z_near = depthQuantile(measured, kNearQuantile);
  const float inv_z_far = depthQuantile(measured, kFarQuantile);
  const float inv_z_range = inv_z_near - inv_z_far;
  const float depth_step = stepOfDepth(noiseQuantile(measured, 1u, 0.0, kStepQuantile),
                                       bentCount(measured),
                                       float(measured.value.changing_count),
                                       inv_z_range);
  const float noise_sigma =
      max(exactQuotient(noiseQuantile(measured, 0u, 0.0, 0.5), kMedianPerSigma),
          settleSmoothing(measured, depth_step, inv_z_range));
  const float given = push.given_kappa;
  measured.value.head.depth_step = depth_step;
  measured.value.head.noise_sigma = noise_sigma;
  const float least = max(leastStep(kKappaRelative, inv_z_range), kRoundingShare * inv_z_near);
  measured.value.head.kappa_abs =
      given > 0.0 ? given
                  : max(least, max(kKappaSteps * depth_step, kKappaSigmas * noise_sigma));
  measured.value.head.kappa_rel = given > 0.0 ? 0.0 : kKappaRelative;
  // The step of one surface is not the step between two things.
  measured.value.head.deep_abs =
      max(leastStep(kDeepStep, inv_z_range), measured.value.head.kappa_abs);
  measured.value.head.inv_z_base =
      hasFault(kFaultStepsFromInfinity) ? 0.0 : baseOfSteps(inv_z_near, inv_z_far);
  measured.value.head.inv_z_far = inv_z_far;
  measured.value.head.inv_z_near = inv_z_near;
}
