// SPDX-License-Identifier: Apache-2.0
// Multiplies floats that are reached by address; proves the plumbing of server/engine/walk/gpu.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require

#include "shared/kernel_constants.h"

layout(constant_id = kIdFree) const uint kFactor = 1;
layout(constant_id = kIdFree + 1u) const uint kOffset = 0;
layout(local_size_x = 64) in;

layout(buffer_reference, scalar) buffer Floats { float at[]; };

layout(push_constant, scalar) uniform Push {
  Floats source;
  Floats target;
  uint count;
} push;

void main() {
  const uint index = gl_GlobalInvocationID.x;
  if (index >= push.count) return;
  push.target.at[index] = push.source.at[index] * float(kFactor) + float(kOffset);
}
