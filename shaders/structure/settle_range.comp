// SPDX-License-Identifier: Apache-2.0
// From the histogram of depth: between which bins its percentiles lie. One invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"
#include "shared/histogram.h"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { BuildPush push; };

void main() {
  MeasuredRef measured = MeasuredRef(push.measured);
  uint surface_count = 0u;
  for (uint bin = 0u; bin < kDepthHistogramBinCount; ++bin) {
    surface_count += measured.value.depth_histogram[bin];
  }
  const float far_wanted = kFarQuantile * float(surface_count);
  const float near_wanted = kNearQuantile * float(surface_count);
  uint far_bin = 0u;
  uint near_bin = 0u;
  uint below_count = 0u;
  uint count = 0u;
  for (uint bin = 0u; bin < kDepthHistogramBinCount; ++bin) {
    const uint here = measured.value.depth_histogram[bin];
    const bool starts_far = here > 0u && float(count) < far_wanted;
    const bool starts_near = here > 0u && float(count) < near_wanted;
    far_bin = starts_far ? bin : far_bin;
    below_count = starts_far ? count : below_count;
    near_bin = starts_near ? bin : near_bin;
    count += here;
  }
  measured.value.head.range = rangeBounds(far_bin, near_bin, below_count, surface_count);
}
