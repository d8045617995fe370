// SPDX-License-Identifier: Apache-2.0
// A chain of dependent loads of 8 bytes, like the visits of a walk, by one of three paths.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "shared/kernel_constants.h"

layout(local_size_x = 64) in;
// 0 none, 1 address, 2 storage binding, 3 texels
layout(constant_id = kIdFree) const uint kPath = 0u;
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Words { uvec2 at[]; };
layout(set = 0, binding = 0, scalar) readonly buffer Storage { uvec2 storage[]; };
layout(set = 0, binding = 1) uniform usamplerBuffer texels;
layout(set = 0, binding = 2, scalar) writeonly buffer Sums { uint sums[]; };
layout(push_constant, scalar) uniform Push {
  uvec2 words;
  uint word_count;  // a power of two
  uint load_count;
};

void main() {
  uint at = gl_GlobalInvocationID.x;
  uint sum = 0u;
  for (uint i = 0u; i < load_count; ++i) {
    uvec2 word = uvec2(at, i);
    if (kPath == 1u) word = Words(words).at[at];
    if (kPath == 2u) word = storage[at];
    if (kPath == 3u) word = texelFetch(texels, int(at)).xy;
    sum += word.x ^ word.y;
    at = (at + 17u + (word.x & 3u)) & (word_count - 1u);
  }
  sums[gl_GlobalInvocationID.x] = sum;
}
