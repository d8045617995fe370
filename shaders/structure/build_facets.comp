// SPDX-License-Identifier: Apache-2.0
// Slopes of every facet (shaders/structure.md, Facets), a block of 4x4 px an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/fault.glsl"
#include "lib/structure/structure_access.glsl"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push {
  BuildPush push;
};

// A pass may be cut into dispatches of some rows of groups each.
uint groupRow() { return push.first_group_row + gl_WorkGroupID.y; }

#include "lib/structure/columns.glsl"
#include "lib/structure/layer_count.glsl"

float loadAt(uint layer, int x, int y) {
  const uint area = invZArea(push.width_px, push.height_px);
  return loadInvZ(push.inv_z, layer, area, invZIndex(invZPitch(push.width_px), uint(x), y));
}

Columns loadColumns(int x, int y) {
  Columns columns;
  for (uint i = 0u; i < kLayerCount; ++i) {
    for (int k = 0; k < 4; ++k) columns.inv_z[i][k] = loadAt(i, x + k, y);
  }
  return columns;
}

// The columns `shift` px further on, -2..2: from the eight around the block.
Columns shifted(Columns left, Columns middle, Columns right, int shift) {
  Columns result;
  for (uint i = 0u; i < kLayerCount; ++i) {
    const vec4 l = left.inv_z[i];
    const vec4 m = middle.inv_z[i];
    const vec4 r = right.inv_z[i];
    result.inv_z[i] = shift == -2   ? vec4(l.zw, m.xy)
                      : shift == -1 ? vec4(l.w, m.xyz)
                      : shift == 1  ? vec4(m.yzw, r.x)
                                    : vec4(m.zw, r.xy);
  }
  return result;
}

vec4 minmod(vec4 a, vec4 b) {
  const vec4 smaller = mix(b, a, lessThanEqual(abs(a), abs(b)));
  return mix(smaller, vec4(0.0), lessThanEqual(a * b, vec4(0.0)));
}

// From the columns one and two px before and after.
vec4 slopeAlong(vec4 inv_z, Columns before_2, Columns before_1, Columns after_1, Columns after_2) {
  const vec4 before = nearestIn(before_1, inv_z);
  const vec4 after = nearestIn(after_1, inv_z);
  const bvec4 has_before = greaterThanEqual(before, vec4(0.0));
  const bvec4 has_after = greaterThanEqual(after, vec4(0.0));
  // With one neighbour alone: the column beyond it.
  const vec4 neighbor = mix(before, after, has_after);
  Columns beyond_columns;
  for (uint i = 0u; i < kLayerCount; ++i) {
    beyond_columns.inv_z[i] = mix(before_2.inv_z[i], after_2.inv_z[i], has_after);
  }
  const vec4 beyond = nearestIn(beyond_columns, neighbor);
  const vec4 outward = minmod(neighbor - inv_z, beyond - neighbor);
  const vec4 one_sided = mix(vec4(0.0), mix(-outward, outward, has_after),
                             greaterThanEqual(min(neighbor, beyond), vec4(0.0)));
  const bvec4 has_both = mix(bvec4(false), has_after, has_before);
  return mix(one_sided, minmod(inv_z - before, after - inv_z), has_both);
}

void storeRow(Extent extent, uint layer, ivec2 pixel, vec4 inv_z, vec4 slope_x, vec4 slope_y) {
  for (int k = 0; k < 4; ++k) {
    const uvec2 facet =
        inv_z[k] < 0.0 ? uvec2(kNoFacet, 0u)
                       : uvec2(floatBitsToUint(inv_z[k]), packSlopes(vec2(slope_x[k], slope_y[k])));
    storeWord(push.layers, layer, extent, facetIndex(extent, pixel) + uint(k), facet);
  }
}

void buildLayer(Extent extent, uint layer, ivec2 pixel, Columns above_2, Columns above_1,
                Columns here, Columns below_1, Columns below_2, Columns left, Columns right) {
  const vec4 inv_z = here.inv_z[layer];
  const vec4 slope_x =
      slopeAlong(inv_z, shifted(left, here, right, -2), shifted(left, here, right, -1),
                 shifted(left, here, right, 1), shifted(left, here, right, 2));
  vec4 slope_y = slopeAlong(inv_z, above_2, above_1, below_1, below_2);
  if (hasFault(kFaultSlopeSign)) slope_y = -slope_y;
  storeRow(extent, layer, pixel, inv_z, slope_x, slope_y);
}

// One row of the block, between those above and below. Layers stand one by one: see
// lib/structure/links.glsl.
void buildRow(Extent extent, ivec2 pixel, Columns above_2, Columns above_1, Columns here,
              Columns below_1, Columns below_2) {
  Columns left;
  Columns right;
  for (uint i = 0u; i < kLayerCount; ++i) {
    left.inv_z[i] =
        vec4(0.0, 0.0, loadAt(i, pixel.x - 2, pixel.y), loadAt(i, pixel.x - 1, pixel.y));
    right.inv_z[i] =
        vec4(loadAt(i, pixel.x + 4, pixel.y), loadAt(i, pixel.x + 5, pixel.y), 0.0, 0.0);
  }
  buildLayer(extent, 0u, pixel, above_2, above_1, here, below_1, below_2, left, right);
  if (kLayerCount > 1u) {
    buildLayer(extent, 1u, pixel, above_2, above_1, here, below_1, below_2, left, right);
  }
  if (kLayerCount > 2u) {
    buildLayer(extent, 2u, pixel, above_2, above_1, here, below_1, below_2, left, right);
  }
  if (kLayerCount > 3u) {
    buildLayer(extent, 3u, pixel, above_2, above_1, here, below_1, below_2, left, right);
  }
}

void main() {
  const ivec2 origin = ivec2(gl_GlobalInvocationID.x, groupRow()) * kBlockPx;
  if (origin.x >= int(push.width_px)) return;
  const Extent extent = makeExtent(ivec2(push.width_px, push.height_px));
  Columns above_2 = loadColumns(origin.x, origin.y - 2);
  Columns above_1 = loadColumns(origin.x, origin.y - 1);
  Columns here = loadColumns(origin.x, origin.y);
  Columns below_1 = loadColumns(origin.x, origin.y + 1);
  int row = 0;
  do {
    const ivec2 pixel = origin + ivec2(0, row);
    const Columns below_2 = loadColumns(origin.x, pixel.y + 2);
    buildRow(extent, pixel, above_2, above_1, here, below_1, below_2);
    above_2 = above_1;
    above_1 = here;
    here = below_1;
    below_1 = below_2;
    ++row;
  } while (row < kBlockPx);
}
