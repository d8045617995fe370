// SPDX-License-Identifier: Apache-2.0
// Histogram of inv_z of layer 0 between its percentiles, of the px that measure_depth.comp takes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"
#include "shared/histogram.h"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push {
  BuildPush push;
};

// A pass may be cut into dispatches of some rows of groups each.
uint groupRow() { return push.first_group_row + gl_WorkGroupID.y; }

void main() {
  MeasuredRef measured = MeasuredRef(push.measured);
  const ivec2 size = ivec2(push.width_px, push.height_px);
  const uint area = invZArea(push.width_px, push.height_px);
  const uint pitch = invZPitch(push.width_px);
  const int y = min(int(groupRow()) * kBlockPx + 2, size.y - 1);
  const int first_x = int(gl_GlobalInvocationID.x) * kMeasuredBlocks;
  // Neighbours mostly share a bin: one atomic for all in a row.
  uint counted_bin = 0u;
  uint count = 0u;
  int block = 0;
  do {
    const int block_x = first_x + block;
    const int x = min(block_x * kBlockPx + 2, size.x - 1);
    const float inv_z = loadInvZ(push.inv_z, 0u, area, invZIndex(pitch, uint(x), y));
    const uint bin = rangeBin(inv_z, measured_head.range);
    if (block_x * kBlockPx < size.x && inv_z >= 0.0 && bin < kRangeHistogramBinCount) {
      if (bin != counted_bin && count > 0u) {
        atomicAdd(measured.value.range_histogram[counted_bin], count);
      }
      count = bin == counted_bin ? count + 1u : 1u;
      counted_bin = bin;
    }
    ++block;
  } while (block < kMeasuredBlocks);
  if (count > 0u) atomicAdd(measured.value.range_histogram[counted_bin], count);
}
