// SPDX-License-Identifier: Apache-2.0
// The name of a surface that a ray met, and of the px where: a plane of the pyramid, or a facet, in
// one word.
//
//   bits 30..28 level | 27..26 layer | 25..13 row | 12..0 column of the px
//
// kMetBackground and kMetAssumed have bit 31 and are the names of none. Sides of up to 8192 px fit.
#ifndef VIEWLOOM_LIB_WALK_MET_SURFACE_GLSL_
#define VIEWLOOM_LIB_WALK_MET_SURFACE_GLSL_

#include "lib/structure/node.glsl"
#include "lib/structure/structure_access.glsl"
#include "lib/walk/walk_state.glsl"
#include "shared/lens_abi.h"

struct MetSurface {
  uint level;
  uint layer;
  ivec2 cell;  // the px
};

// `is_known`: the ray has a colour, be it an assumed one.
uint nameOfMet(Walk walk, bool is_known) {
  const uvec2 cell = uvec2(walk.cell);
  const uint name = walk.level << 28 | walk.layer << 26 | cell.y << 13 | cell.x;
  return walk.is_hit ? name : is_known ? kMetAssumed : kMetBackground;
}

MetSurface metSurface(uint name) {
  return MetSurface(name >> 28 & 7u, name >> 26 & 3u, ivec2(uvec2(name, name >> 13) & 0x1fffu));
}

uvec2 loadSurface(Address layers[kLayerCountMax], Extent extent, MetSurface surface) {
  const uvec2 cell = uvec2(surface.cell) >> surface.level;
  return loadCell(layers, surface.layer, extent, surface.level, cell);
}

// The plane: inv_z = x plane.x + y plane.y + plane.z.
vec3 planeOf(MetSurface surface, uvec2 bits) {
  const vec2 slope = unpackSlopes(bits.y);
  const float inv_z = surface.level == kLevelFacets
                          ? uintBitsToFloat(bits.x & ~kForwardLinkFlag)
                          : planeCenter(bits);
  const uvec2 first_px = uvec2(surface.cell) >> surface.level << surface.level;
  const vec2 center = vec2(first_px) + 0.5 * float(1u << surface.level);
  return vec3(slope, inv_z - dot(slope, center));
}

#endif  // VIEWLOOM_LIB_WALK_MET_SURFACE_GLSL_
