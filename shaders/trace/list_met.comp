// SPDX-License-Identifier: Apache-2.0
// The surfaces that the walked rays of each block of 8x8 px met, each once, in the order in which
// they are found: an invocation a block. What lies outside the band is not looked at.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "shared/trace_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(push_constant, scalar) uniform Push {
  GatherPush push;
};
layout(set = 0, binding = kBindingMet, scalar) readonly buffer Met {
  uint met[];
};
layout(set = 0, binding = kBindingMetLists, scalar) buffer MetLists {
  uint lists[];
};

#include "lib/met_blocks.glsl"

void main() {
  const uint block_column = gl_GlobalInvocationID.x;
  const uint block_row = gl_WorkGroupID.y;
  const uint blocks_per_row = blocksPerRow(push);
  if (block_column >= blocks_per_row) return;
  const MetBlock block = metBlock(push, block_column, block_row);
  const uint list = (block_row * blocks_per_row + block_column) * kMetListStride;
  uint count = 0u;
  uint last = kMetNothing;
  for (uint sample_index = 0u; sample_index < push.walked_count; ++sample_index) {
    for (uint y = block.first_row; y < block.end_row; ++y) {
      for (uint x = block.first_x; x < block.end_x; ++x) {
        const uint name =
            met[(sample_index * push.row_count + y) * push.atlas_width_px + x];
        if (name == last || name == kMetNothing) continue;
        last = name;
        bool is_listed = false;
        for (uint i = 0u; i < count; ++i) is_listed = is_listed || lists[list + 1u + i] == name;
        if (is_listed) continue;
        if (count < kMetListMax) lists[list + 1u + count] = name;
        ++count;
      }
      if (count > kMetListMax) break;
    }
    if (count > kMetListMax) break;
  }
  // More than there is room for: the walked rays alone make these px.
  lists[list] = count > kMetListMax ? 0u : count;
}
