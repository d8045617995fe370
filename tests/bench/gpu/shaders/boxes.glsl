// SPDX-License-Identifier: Apache-2.0
// A min/max pyramid as it lies in memory: per layer boxes of 2^level x 2^level px, least and
// largest inv_z of what a ray may meet in them. Level 0 comes first, and each is a quarter of the
// one below it. Of the levels between those that a walk uses only 5 is made, where rays may start.
#ifndef VIEWLOOM_BENCH_BOXES_GLSL_
#define VIEWLOOM_BENCH_BOXES_GLSL_

#include "rival_abi.h"

layout(set = 0, binding = kBindingBoxes) uniform usamplerBuffer box_texels;

const float kBoxEmpty = 3.4e38;  // the least inv_z of nothing

uvec2 paddedSize(uvec2 size_px) {
  const uint mask = (1u << kBoxLevelLast) - 1u;
  return (size_px + mask) & ~mask;
}

// In units of the cells of level 6, the levels from one on have 5461 >> 2 level cells:
// 0b1010101010101.
uint boxIndex(uvec2 padded_px, uint level, uvec2 cell) {
  const uint begin = (0x1555u - (0x1555u >> (2u * level))) * (padded_px.x * padded_px.y / 4096u);
  return begin + cell.y * (padded_px.x >> level) + cell.x;
}

// One word a cell, for one gather a visit. Level 0: inv_z. Others: the upper halves of the least,
// which is rounded down, and of the largest, rounded up; bounds of half their bits cost few visits.
uint packBox(vec2 box) {
  const uint low = box.x < 0.0 ? 0u : floatBitsToUint(box.x) >> 16;
  const uint high = box.y < 0.0 ? 0u : (floatBitsToUint(box.y) + 0xffffu) >> 16;
  return low | (high << 16);
}

vec2 boxOfWord(uint word, uint level, vec3 kappa) {
  const float high = uintBitsToFloat(level == 0u ? word : word & 0xffff0000u);
  const float thickness = max(kappa.x, kappa.y * (high - kappa.z));
  const float low = level == 0u ? high - thickness : uintBitsToFloat(word << 16);
  return vec2(low, high);
}

#endif  // VIEWLOOM_BENCH_BOXES_GLSL_
