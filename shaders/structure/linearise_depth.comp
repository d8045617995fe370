// SPDX-License-Identifier: Apache-2.0
// Depth samples of all layers of a column to inv_z, in canonical form: nearest first, no duplicates,
// no gaps. Counts what was bad and what was unsorted.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/structure_access.glsl"

layout(local_size_x = kBuildGroupWidth, local_size_y = kBuildGroupHeight) in;
layout(push_constant, scalar) uniform Push { BuildPush push; };

float loadSample(DepthPlane plane, uint index) {
  if (plane.sample_type == kDepthSampleF32) return FloatRef(plane.samples).at[index];
  const uint bits = uint(Uint16Ref(plane.samples).at[index]);
  return plane.sample_type == kDepthSampleF16 ? unpackHalf2x16(bits).x : float(bits);
}

// inv_z, kNoSurface, or NaN for a bad sample (frame/depth.h linearizeDepth is the reference).
float linearise(DepthPlane plane, float depth_sample, float ray_length) {
  if (plane.has_invalid != 0u && depth_sample == plane.invalid_value) {
    return plane.invalid_is_far != 0u ? 0.0 : kNoSurface;
  }
  const float bad = uintBitsToFloat(0x7fc00000u);
  const float value = (depth_sample - plane.origin) * plane.scale + plane.offset;
  if (!(value >= 0.0)) return bad;
  if (plane.reciprocal == 0u) return value <= plane.inv_z_max ? value : bad;
  if (value == 0.0) return kNoSurface;
  const float inv_z = (isinf(value) ? 0.0 : 1.0 / value) * (plane.ray_distance != 0u ? ray_length : 1.0);
  return inv_z <= plane.inv_z_max ? inv_z : bad;
}

void main() {
  StructureRef structure = StructureRef(push.structure);
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= int(structure.value.width_px) || pixel.y >= int(structure.value.height_px)) return;
  const uint index = pixelIndex(structure, pixel);
  const uint layer_count = structure.value.layer_count;
  const vec2 principal_px = vec2(structure.value.principal_x_px, structure.value.principal_y_px);
  const vec2 focal_px = vec2(structure.value.focal_x_px, structure.value.focal_y_px);
  const float ray_length = length(vec3((vec2(pixel) + 0.5 - principal_px) / focal_px, 1.0));

  float column[kLayerCountMax];
  uint count = 0u;
  uint bad_count = 0u;
  bool is_sorted = true;
  for (uint layer = 0u; layer < layer_count; ++layer) {
    const DepthPlane plane = structure.value.depth[layer];
    const float inv_z = linearise(plane, loadSample(plane, index), ray_length);
    if (isnan(inv_z)) ++bad_count;
    if (!(inv_z >= 0.0)) continue;
    // Insertion from the back: far layers usually come last.
    uint at = count;
    while (at > 0u && column[at - 1u] < inv_z) {
      column[at] = column[at - 1u];
      --at;
      is_sorted = false;
    }
    column[at] = inv_z;
    ++count;
  }

  const vec3 step_terms = structure.value.depth[0].format_step;
  uint kept = 0u;
  for (uint i = 0u; i < count; ++i) {
    const float inv_z = column[i];
    const float format_step = step_terms.x + inv_z * (step_terms.y + inv_z * step_terms.z);
    if (kept > 0u && column[kept - 1u] - inv_z <= format_step) continue;
    column[kept] = inv_z;
    ++kept;
  }
  for (uint layer = 0u; layer < layer_count; ++layer) {
    FloatRef(structure.value.inv_z[layer]).at[index] = layer < kept ? column[layer] : kNoSurface;
  }

  MeasuredRef measured = MeasuredRef(structure.value.measured);
  if (bad_count > 0u) atomicAdd(measured.value.bad_samples_count, bad_count);
  if (!is_sorted) atomicAdd(measured.value.unsorted_columns_count, 1u);
}
