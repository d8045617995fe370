// SPDX-License-Identifier: Apache-2.0
// Facets as they are stored: inv_z as binary32, two slopes of 16 bits each.
#ifndef VIEWLOOM_LIB_FACET_GLSL_
#define VIEWLOOM_LIB_FACET_GLSL_

#include "shared/structure_abi.h"

// A slope keeps a sign, 6 bits of exponent and 9 of mantissa: 10 significant bits over 2^-39 ..
// 2^24 (1/m per px), so no scene needs a scale of its own. 0.5 px away the rounding moves a surface
// by less than 2^-12 of its slope.
// 2^87: exponent 0 stands for 2^-40
const float kSlopeExponentScale = 154742504910672534362390528.0;

uint packSlope(float slope) {
  const uint magnitude = floatBitsToUint(abs(slope) * (1.0 / kSlopeExponentScale));
  const uint rounded = min((magnitude + 0x2000u) >> 14, 0x7fffu);  // half away from zero
  return (rounded < 0x200u ? 0u : rounded) | (slope < 0.0 && rounded >= 0x200u ? 0x8000u : 0u);
}

float unpackSlope(uint bits) {
  const float magnitude = uintBitsToFloat((bits & 0x7fffu) << 14) * kSlopeExponentScale;
  return (bits & 0x8000u) != 0u ? -magnitude : magnitude;
}

uint packSlopes(vec2 slope) {
  return packSlope(slope.x) | (packSlope(slope.y) << 16);
}

vec2 unpackSlopes(uint bits) {
  return vec2(unpackSlope(bits & 0xffffu), unpackSlope(bits >> 16));
}

// The facet's plane, `offset` px from its sample; never below the sky.
float facetAt(float inv_z, vec2 slope, vec2 offset) {
  return max(0.0, inv_z + slope.x * offset.x + slope.y * offset.y);
}

// The smallest and largest inv_z of a facet over its footprint. Three roundings, each of at most
// half an ulp of the largest value: outward by one to two ulp of that.
vec2 facetBox(float inv_z, vec2 slope) {
  precise const float half_range = 0.5 * (abs(slope.x) + abs(slope.y));
  precise const float margin = (inv_z + half_range) * 1.1920928955078125e-7;
  precise const float low = (inv_z - half_range) - margin;
  precise const float high = (inv_z + half_range) + margin;
  return vec2(max(0.0, low), high);
}

#endif  // VIEWLOOM_LIB_FACET_GLSL_
