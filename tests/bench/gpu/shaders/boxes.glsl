// SPDX-License-Identifier: Apache-2.0
// A min/max pyramid as it lies in memory: per layer boxes of 2^level x 2^level px, least and
// largest inv_z of what a ray may meet in them. The last level comes first, and each is a quarter
// of the one below it (as in shaders/shared/structure_abi.h).
#ifndef VIEWLOOM_BENCH_BOXES_GLSL_
#define VIEWLOOM_BENCH_BOXES_GLSL_

#include "rival_abi.h"

layout(set = 0, binding = kBindingBoxes) uniform samplerBuffer box_texels;

const float kBoxEmpty = 3.4e38;  // the least inv_z of nothing

uvec2 paddedSize(uvec2 size_px) {
  const uint mask = (1u << kBoxLevelLast) - 1u;
  return (size_px + mask) & ~mask;
}

// Levels 6, 5, 4 ... begin at 0, 1, 5 ... times the cells of level 6: the leading bits of
// 0b10101010101.
uint boxIndex(uvec2 padded_px, uint level, uvec2 cell) {
  const uint begin = (0x555u >> (2u * level)) * (padded_px.x * padded_px.y / 4096u);
  return begin + cell.y * (padded_px.x >> level) + cell.x;
}

// Texels of one float: lavapipe gathers those with one instruction, and pairs lane by lane.
vec2 loadBox(uint index) {
  const int at = 2 * int(index);
  return vec2(texelFetch(box_texels, at).x, texelFetch(box_texels, at + 1).x);
}

#endif  // VIEWLOOM_BENCH_BOXES_GLSL_
