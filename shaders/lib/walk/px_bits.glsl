// SPDX-License-Identifier: Apache-2.0
// Sets of px of a run, of which there are no more than 64.
#ifndef VIEWLOOM_LIB_WALK_PX_BITS_GLSL_
#define VIEWLOOM_LIB_WALK_PX_BITS_GLSL_

uvec2 bitOf(uint i) {
  const uint bit = 1u << (i & 31u);
  return i > 31u ? uvec2(0u, bit) : uvec2(bit, 0u);
}

bool isIn(uvec2 bits, uint i) {
  return ((i > 31u ? bits.y : bits.x) >> (i & 31u) & 1u) != 0u;
}

uint lowestBit(uvec2 bits) {
  return bits.x != 0u ? uint(findLSB(bits.x)) : 32u + uint(findLSB(bits.y));
}

uvec2 withoutLowestBit(uvec2 bits) {
  return bits.x != 0u ? uvec2(bits.x & (bits.x - 1u), bits.y)
                      : uvec2(0u, bits.y & (bits.y - 1u));
}

#endif  // VIEWLOOM_LIB_WALK_PX_BITS_GLSL_
