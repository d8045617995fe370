// SPDX-License-Identifier: Apache-2.0
// Slopes of every facet (shaders/README.md, Facets).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/fault.glsl"
#include "lib/structure_access.glsl"

layout(local_size_x = kBuildGroupWidth, local_size_y = kBuildGroupHeight) in;
layout(constant_id = kOwnConstants) const uint kLayerCount = 2u;
layout(push_constant, scalar) uniform Push { BuildPush push; };

struct Column {
  float inv_z[kLayerCountMax];
};

Column loadColumn(ivec2 pixel) {
  const ivec2 size = ivec2(push.width_px, push.height_px);
  Column column;
  const bool exists = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
  const ivec2 inside = clamp(pixel, ivec2(0), size - 1);
  const uint index = uint(inside.y) * push.width_px + uint(inside.x);
  for (uint i = 0u; i < kLayerCount; ++i) {
    const float inv_z = loadInvZ(push.inv_z, i, push.width_px * push.height_px, index);
    column.inv_z[i] = exists ? inv_z : kNoSurface;
  }
  return column;
}

// The surface of a column whose inv_z is nearest; kNoSurface where there is none.
float nearestIn(Column column, float inv_z) {
  float nearest = column.inv_z[0];
  for (uint i = 1u; i < kLayerCount; ++i) {
    const float other = column.inv_z[i];
    nearest = other >= 0.0 && abs(other - inv_z) < abs(nearest - inv_z) ? other : nearest;
  }
  return nearest;
}

float minmod(float a, float b) {
  return a * b <= 0.0 ? 0.0 : (abs(a) <= abs(b) ? a : b);
}

// `beyond` lies on the side of the only neighbour, one column further on.
float slopeAlong(float inv_z, Column before_column, Column after_column, Column beyond_column) {
  const float before = nearestIn(before_column, inv_z);
  const float after = nearestIn(after_column, inv_z);
  if (before >= 0.0 && after >= 0.0) return minmod(inv_z - before, after - inv_z);
  const bool has_after = after >= 0.0;
  const float neighbor = has_after ? after : before;
  if (neighbor < 0.0) return 0.0;
  const float beyond = nearestIn(beyond_column, neighbor);
  if (beyond < 0.0) return 0.0;
  const float slope = minmod(neighbor - inv_z, beyond - neighbor);
  return has_after ? slope : -slope;
}

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= int(push.width_px) || pixel.y >= int(push.height_px)) return;
  const Extent extent = makeExtent(ivec2(push.width_px, push.height_px));
  const Column here = loadColumn(pixel);
  const Column left = loadColumn(pixel - ivec2(1, 0));
  const Column right = loadColumn(pixel + ivec2(1, 0));
  const Column above = loadColumn(pixel - ivec2(0, 1));
  const Column below = loadColumn(pixel + ivec2(0, 1));
  // Layer 0 exists wherever any layer does.
  const Column beyond_x = loadColumn(pixel + ivec2(right.inv_z[0] >= 0.0 ? 2 : -2, 0));
  const Column beyond_y = loadColumn(pixel + ivec2(0, below.inv_z[0] >= 0.0 ? 2 : -2));
  for (uint i = 0u; i < kLayerCount; ++i) {
    const float inv_z = here.inv_z[i];
    vec2 slope =
        vec2(slopeAlong(inv_z, left, right, beyond_x), slopeAlong(inv_z, above, below, beyond_y));
    if (hasFault(kFaultSlopeSign)) slope.y = -slope.y;
    const uvec2 facet =
        inv_z < 0.0 ? uvec2(kNoFacet, 0u) : uvec2(floatBitsToUint(inv_z), packSlopes(slope));
    storeWord(push.layers, i, extent, facetIndex(extent, pixel), facet);
  }
}
