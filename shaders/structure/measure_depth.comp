// SPDX-License-Identifier: Apache-2.0
// Histograms of layer 0: of inv_z, and of its second differences; and at how many places it
// changes. One px of every 4x4 block is enough, and which one is fixed: the result depends on
// nothing but the frame.
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

float nearestInvZ(ivec2 pixel) {
  const uint area = invZArea(push.width_px, push.height_px);
  const uint pitch = invZPitch(push.width_px);
  return loadInvZ(push.inv_z, 0u, area, invZIndex(pitch, uint(pixel.x), pixel.y));
}

// Samples of one bin in a row, added with one atomic when another bin comes: neighbours mostly
// share a bin, and atomics on the few bins of a flat scene would wait for each other.
struct Tally {
  uint bin;
  uint count;
};

void addToDepths(MeasuredRef measured, Tally tally) {
  if (tally.count > 0u) atomicAdd(measured.value.depth_histogram[tally.bin], tally.count);
}

void addToNoise(MeasuredRef measured, Tally tally) {
  if (tally.count > 0u) atomicAdd(measured.value.noise_histogram[tally.bin], tally.count);
}

Tally withSample(Tally tally, uint bin) {
  return Tally(bin, bin == tally.bin ? tally.count + 1u : 1u);
}

void main() {
  MeasuredRef measured = MeasuredRef(push.measured);
  const ivec2 size = ivec2(push.width_px, push.height_px);
  const int y = min(int(groupRow()) * kBlockPx + 2, size.y - 1);
  const int first_x = int(gl_GlobalInvocationID.x) * kMeasuredBlocks;
  Tally depths = Tally(0u, 0u);
  Tally noise = Tally(0u, 0u);
  uint changing_count = 0u;
  int block = 0;
  do {
    const int block_x = first_x + block;
    const bool is_in_image = block_x * kBlockPx < size.x;
    const ivec2 pixel = ivec2(min(block_x * kBlockPx + 2, size.x - 1), y);
    const bool is_along_x = ((block_x + int(groupRow())) & 1) == 0;
    const ivec2 along = is_along_x ? ivec2(1, 0) : ivec2(0, 1);
    // Around the image lies the guard of no surface.
    const float before = nearestInvZ(pixel - along);
    const float inv_z = nearestInvZ(pixel);
    const float after = nearestInvZ(pixel + along);
    if (is_in_image && inv_z >= 0.0) {
      const uint bin = depthBin(inv_z);
      if (bin != depths.bin) addToDepths(measured, depths);
      depths = withSample(depths, bin);
    }
    if (is_in_image && min(inv_z, min(before, after)) >= 0.0) {
      const float difference = abs((after - inv_z) - (inv_z - before));
      const uint bin = noiseBin(isLevel(difference, inv_z) ? 0.0 : difference);
      const bool is_level = isLevel(after - inv_z, inv_z) && isLevel(inv_z - before, inv_z);
      changing_count += is_level ? 0u : 1u;
      if (bin != noise.bin) addToNoise(measured, noise);
      noise = withSample(noise, bin);
    }
    ++block;
  } while (block < kMeasuredBlocks);
  addToDepths(measured, depths);
  addToNoise(measured, noise);
  if (changing_count > 0u) atomicAdd(measured.value.changing_count, changing_count);
}
