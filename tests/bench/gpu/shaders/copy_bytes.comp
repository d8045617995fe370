// SPDX-License-Identifier: Apache-2.0
// Reads 16 bytes an invocation, once, and writes them as often as the output is longer.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"

#include "rival_abi.h"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push {
  CopyPush push;
};
layout(set = 0, binding = kBindingFrom) uniform usamplerBuffer from;
layout(set = 0, binding = kBindingTo, scalar) writeonly buffer To {
  uvec4 to[];
};

void main() {
  const uint at = gl_WorkGroupID.y * push.row_count + gl_GlobalInvocationID.x;
  if (gl_GlobalInvocationID.x >= push.row_count || at >= push.from_count) return;
  const uvec4 words = texelFetch(from, int(push.from_first + at));
  uint next = at;
  do {
    to[next] = words;
    next += push.from_count;
  } while (next < push.to_count);
}
