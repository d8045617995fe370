// SPDX-License-Identifier: Apache-2.0
// Facets as they are stored: inv_z as binary32, two slopes of 16 bits each.
#ifndef VIEWLOOM_LIB_STRUCTURE_FACET_GLSL_
#define VIEWLOOM_LIB_STRUCTURE_FACET_GLSL_

#include "shared/structure_abi.h"

// A slope keeps the upper 16 bits of its binary32: 8 significant bits of any exponent, so no scene
// needs a scale of its own, and two of them unpack in two operations. 0.5 px away the rounding
// moves a surface by at most 2^-10 of its slope.
// 2^-100: smaller ones are 0, so that no rounding meets a subnormal number.
const float kSlopeMin = 7.888609052210118e-31;

uint packSlope(float slope) {
  const uint rounded = (floatBitsToUint(slope) + 0x8000u) >> 16;  // half away from zero
  return abs(slope) < kSlopeMin ? 0u : rounded;
}

uint packSlopes(vec2 slope) {
  return packSlope(slope.x) | (packSlope(slope.y) << 16);
}

vec2 unpackSlopes(uint bits) {
  return vec2(uintBitsToFloat(bits << 16), uintBitsToFloat(bits & 0xffff0000u));
}

// The signs of both slopes, to mirror a plane with one operation.
const uvec2 kSlopeSigns = uvec2(0x8000u, 0x80000000u);

// The facet's plane, `offset` px from its sample; never below the sky.
float facetAt(float inv_z, vec2 slope, vec2 offset) {
  return max(0.0, inv_z + slope.x * offset.x + slope.y * offset.y);
}

#endif  // VIEWLOOM_LIB_STRUCTURE_FACET_GLSL_
