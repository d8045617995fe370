// SPDX-License-Identifier: Apache-2.0
// Columns in canonical form: nearest first, no duplicates, no gaps. Counts those that came
// unsorted.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"

layout(local_size_x = kBuildGroupWidth, local_size_y = kBuildGroupHeight) in;
layout(constant_id = kOwnConstants) const uint kLayerCount = 2u;
layout(push_constant, scalar) uniform Push { BuildPush push; };

void main() {
  const uvec2 pixel = gl_GlobalInvocationID.xy;
  bool is_unsorted = false;
  if (pixel.x < push.width_px && pixel.y < push.height_px) {
    const uint area = push.width_px * push.height_px;
    const uint index = pixel.y * push.width_px + pixel.x;
    float column[kLayerCountMax];
    for (uint i = 0u; i < kLayerCount; ++i) column[i] = loadInvZ(push.inv_z, i, area, index);

    // A surface behind a gap counts as in order; one in front of an earlier surface does not.
    float farthest = 3.4e38;
    for (uint i = 0u; i < kLayerCount; ++i) {
      is_unsorted = is_unsorted || column[i] > farthest;
      farthest = column[i] >= 0.0 ? column[i] : farthest;
    }
    // Exchange sort: no surface (-1) sinks to the end by itself.
    for (uint i = 0u; i + 1u < kLayerCount; ++i) {
      for (uint j = 0u; j + 1u + i < kLayerCount; ++j) {
        const float near = max(column[j], column[j + 1u]);
        const float far = min(column[j], column[j + 1u]);
        column[j] = near;
        column[j + 1u] = far;
      }
    }
    float kept[kLayerCountMax];
    for (uint i = 0u; i < kLayerCount; ++i) kept[i] = kNoSurface;
    uint count = 0u;
    float last = 3.4e38;
    for (uint i = 0u; i < kLayerCount; ++i) {
      const float inv_z = column[i];
      const float format_step =
          push.format_step.x + inv_z * (push.format_step.y + inv_z * push.format_step.z);
      if (inv_z < 0.0 || last - inv_z <= format_step) continue;
      for (uint j = 0u; j <= i; ++j) kept[j] = j == count ? inv_z : kept[j];
      ++count;
      last = inv_z;
    }
    for (uint i = 0u; i < kLayerCount; ++i) storeInvZ(push.inv_z[i], i, area, index, kept[i]);
  }
  MeasuredRef measured = MeasuredRef(push.measured);
  if (is_unsorted) atomicAdd(measured.value.head.unsorted_columns_count, 1u);
}
