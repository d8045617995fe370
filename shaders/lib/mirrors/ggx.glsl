// SPDX-License-Identifier: Apache-2.0
// How rough surfaces mirror: the microfacets of GGX, sampled as far as they are seen.
#ifndef VIEWLOOM_LIB_MIRRORS_GGX_GLSL_
#define VIEWLOOM_LIB_MIRRORS_GGX_GLSL_

#include "shared/ggx.h"

// A surface that mirrors less than 2 % head on mirrors less along it, too: none does else.
const float kReflectanceOfAll = 0.02;

// Off its edge, of what it mirrors head on.
float reflectanceAlong(vec3 head_on) {
  return min(max(head_on.r, max(head_on.g, head_on.b)) / kReflectanceOfAll, 1.0);
}

// `cosine` of the angle to the microfacet's normal.
vec3 fresnel(vec3 head_on, float cosine) {
  return head_on + max(reflectanceAlong(head_on) - head_on, 0.0) * fresnelRest(cosine);
}

// Two vectors across a normal (Duff et al., Building an Orthonormal Basis, Revisited, 2017).
mat3 basisAround(vec3 normal) {
  const float side = normal.z >= 0.0 ? 1.0 : -1.0;
  const float a = -1.0 / (side + normal.z);
  const float b = normal.x * normal.y * a;
  return mat3(vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x),
              vec3(b, side + normal.y * normal.y * a, -normal.y), normal);
}

// Fractions of 2^32.
float inUnit(uint place) {
  return float(place >> 8) * (1.0 / 16777216.0);
}

// The i-th of `count` places in a unit square, for a px: a lattice, one in each stratum along x, so
// that the i-th rays of neighbouring px go about the same way. Those of 4x4 px are moved against
// each other by R2 of Roberts, and blocks at random; further bounces go by other lattices. The same
// in every frame.
vec2 samplePlace(uint i, uint count, uint bounce, uvec2 px, uint ray_index) {
  const uvec2 low = px & 3u;
  const uint crossed = low.x ^ low.y;
  const uint rank =
      ((crossed & 1u) << 3) | ((low.y & 1u) << 2) | (crossed & 2u) | ((low.y >> 1) & 1u);
  const uvec2 block = (px >> 2) + uvec2(ray_index << 16, bounce << 16);  // tiles have fewer
  uint turn = block.x * 0x9e3779b1u ^ (block.y * 0x85ebca77u + 0x27d4eb2fu);
  turn = (turn ^ (turn >> 15)) * 0x2c1b3c6du;
  turn = (turn ^ (turn >> 12)) * 0x297a2d39u;
  turn ^= turn >> 15;
  const uvec2 own = uvec2(0xc13fa9a9u, 0x91e10da5u) * rank + uvec2(turn, turn * 0x9e3779b1u);
  const uint across = 0x9e3779b9u + 0xbbe05633u * bounce;
  const float along = bounce == 0u ? (float(i) + inUnit(own.x)) / float(count)
                                   : inUnit(own.x + 0xdb4f0b91u * bounce * i);
  return vec2(along, inUnit(own.y + across * i));
}

#endif  // VIEWLOOM_LIB_MIRRORS_GGX_GLSL_
