// SPDX-License-Identifier: Apache-2.0
// Adds one sample of every px of a band to those before it, as light; the last makes px of the
// sums.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"
#include "lib/light/srgb.glsl"
#include "shared/trace_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(push_constant, scalar) uniform Push {
  BlendPush push;
};
layout(set = 0, binding = kBindingSample, scalar) readonly buffer Sample {
  uint sample_band[];
};
layout(set = 0, binding = kBindingSums, scalar) buffer Sums {
  vec3 sums[];
};
layout(set = 0, binding = kBindingBand, scalar) writeonly buffer Band {
  uint band[];
};

void main() {
  const uint index = gl_GlobalInvocationID.y * kTraceGroupSize * gl_NumWorkGroups.x +
                     gl_GlobalInvocationID.x;
  if (index >= push.px_count) return;
  const vec3 codes = codesOfRgba8(sample_band[index]);
  const vec3 light = push.weights * linearFromSrgb(codes / 255.0);
  const vec3 sum = push.is_first != 0u ? light : sums[index] + light;
  sums[index] = sum;
  if (push.is_last == 0u) return;
  const vec3 mean_codes = codesFromLinear(sum);
  band[index] = packCodes(mean_codes);
  if (push.linear != uvec2(0u)) {
    Vec4Ref(push.linear).at[index] = vec4(clamp(mean_codes / 255.0, 0.0, 1.0), 1.0);
  }
}
