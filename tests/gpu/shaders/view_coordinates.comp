// SPDX-License-Identifier: Apache-2.0
// Where among the views each subpixel of a panel lies, to be compared with what C++ makes of the
// same lines.
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/lenticular.h"

layout(local_size_x = 64) in;

layout(buffer_reference, scalar) buffer Words { uint at[]; };

layout(push_constant, scalar) uniform Push {
  Words target;  // [height][width][channel]: coordinate's bits, nearest view
  uint width_px;
  uint view_count;
  Lenticular lens;
} push;

void main() {
  uint pixel = gl_GlobalInvocationID.x;
  if (pixel >= push.width_px * push.lens.height_px) return;
  for (uint channel = 0u; channel < kCellChannels; ++channel) {
    float coordinate =
        viewCoordinate(push.lens, pixel % push.width_px, pixel / push.width_px, channel);
    uint index = 2u * (kCellChannels * pixel + channel);
    push.target.at[index] = floatBitsToUint(coordinate);
    push.target.at[index + 1u] = nearestView(coordinate, push.view_count);
  }
}
