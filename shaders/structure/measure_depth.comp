// SPDX-License-Identifier: Apache-2.0
// Histograms of layer 0: of inv_z, and of its second differences. One px of every 4x4 block is
// enough, and which one is fixed: the result depends on nothing but the frame.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/histogram.glsl"
#include "lib/memory.glsl"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push {
  BuildPush push;
};

// Differences of a few roundings are none: 8 ulp.
const float kRoundingShare = 8.0 / 8388608.0;

float nearestInvZ(ivec2 pixel) {
  const uint area = invZArea(push.width_px, push.height_px);
  const uint pitch = invZPitch(push.width_px);
  return loadInvZ(push.inv_z, 0u, area, invZIndex(pitch, uint(pixel.x), pixel.y));
}

void main() {
  MeasuredRef measured = MeasuredRef(push.measured);
  const ivec2 size = ivec2(push.width_px, push.height_px);
  const ivec2 block = ivec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y);
  if (block.x * kBlockPx >= size.x) return;
  const ivec2 pixel = min(block * kBlockPx + 2, size - 1);

  const float inv_z = nearestInvZ(pixel);
  if (inv_z < 0.0) return;
  atomicAdd(measured.value.head.surface_count, 1u);
  atomicAdd(measured.value.depth_histogram[depthBin(inv_z)], 1u);

  const ivec2 along = ((block.x + block.y) & 1) == 0 ? ivec2(1, 0) : ivec2(0, 1);
  const ivec2 before = pixel - along;
  const ivec2 after = pixel + along;
  if (any(lessThan(before, ivec2(0))) || any(greaterThanEqual(after, size))) return;
  const float inv_z_before = nearestInvZ(before);
  const float inv_z_after = nearestInvZ(after);
  if (inv_z_before < 0.0 || inv_z_after < 0.0) return;
  const float difference = abs((inv_z_after - inv_z) - (inv_z - inv_z_before));
  const float seen = difference <= inv_z * kRoundingShare ? 0.0 : difference;
  atomicAdd(measured.value.noise_histogram[noiseBin(seen)], 1u);
}
