// SPDX-License-Identifier: Apache-2.0
// The name of a surface that a ray met: a plane of the pyramid, or a facet, in one word.
//
//   bits 30..28 level | 27..26 layer | 25..13 row | 12..0 column, in units of the level's own cells
//
// kMetNothing has bit 31 and is the name of none. Sides of up to 8192 px fit.
#ifndef VIEWLOOM_LIB_MET_SURFACE_GLSL_
#define VIEWLOOM_LIB_MET_SURFACE_GLSL_

#include "lib/walk.glsl"

struct MetSurface {
  uint level;
  uint layer;
  ivec2 first_px;  // its upper left px
};

uint nameOfMet(Walk walk) {
  const uvec2 block = uvec2(walk.cell) >> walk.level;
  const uint name = walk.level << 28 | walk.layer << 26 | block.y << 13 | block.x;
  return walk.is_hit ? name : kMetNothing;
}

MetSurface metSurface(uint name) {
  const uint level = name >> 28 & 7u;
  const uvec2 block = uvec2(name, name >> 13) & 0x1fffu;
  return MetSurface(level, name >> 26 & 3u, ivec2(block << level));
}

#endif  // VIEWLOOM_LIB_MET_SURFACE_GLSL_
