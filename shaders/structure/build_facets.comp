// SPDX-License-Identifier: Apache-2.0
// Slopes of every facet (shaders/README.md, Facets).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/facet.glsl"
#include "lib/structure_access.glsl"

layout(local_size_x = kBuildGroupWidth, local_size_y = kBuildGroupHeight) in;
layout(push_constant, scalar) uniform Push { BuildPush push; };

// The surface of a column whose inv_z is nearest; kNoSurface where there is none.
float nearestInColumn(StructureRef structure, ivec2 pixel, float inv_z) {
  const ivec2 size = ivec2(structure.value.width_px, structure.value.height_px);
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size))) return kNoSurface;
  float nearest = loadInvZ(structure, 0u, pixel);
  for (uint layer = 1u; layer < structure.value.layer_count; ++layer) {
    const float other = loadInvZ(structure, layer, pixel);
    if (other >= 0.0 && abs(other - inv_z) < abs(nearest - inv_z)) nearest = other;
  }
  return nearest;
}

float minmod(float a, float b) {
  if (a * b <= 0.0) return 0.0;
  return abs(a) <= abs(b) ? a : b;
}

// Only one neighbour: its difference, checked against the one beyond it.
float oneSidedSlope(StructureRef structure, ivec2 neighbor, ivec2 along, float inv_z, float neighbor_inv_z) {
  const float beyond = nearestInColumn(structure, neighbor + along, neighbor_inv_z);
  if (beyond < 0.0) return 0.0;
  return minmod(neighbor_inv_z - inv_z, beyond - neighbor_inv_z);
}

float slopeAlong(StructureRef structure, ivec2 pixel, ivec2 axis, float inv_z) {
  const float before = nearestInColumn(structure, pixel - axis, inv_z);
  const float after = nearestInColumn(structure, pixel + axis, inv_z);
  if (before >= 0.0 && after >= 0.0) return minmod(inv_z - before, after - inv_z);
  if (after >= 0.0) return oneSidedSlope(structure, pixel + axis, axis, inv_z, after);
  if (before >= 0.0) return -oneSidedSlope(structure, pixel - axis, -axis, inv_z, before);
  return 0.0;
}

void main() {
  StructureRef structure = StructureRef(push.structure);
  const uint layer = gl_WorkGroupID.z;
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= int(structure.value.width_px) || pixel.y >= int(structure.value.height_px)) return;
  const float inv_z = loadInvZ(structure, layer, pixel);
  vec2 slope = vec2(0.0);
  if (inv_z >= 0.0) {
    slope.x = slopeAlong(structure, pixel, ivec2(1, 0), inv_z);
    slope.y = slopeAlong(structure, pixel, ivec2(0, 1), inv_z);
  }
  const uint index = pixelIndex(structure, pixel);
  Uvec2Ref(structure.value.facets[layer]).at[index] = uvec2(floatBitsToUint(inv_z), packSlopes(slope));
}
