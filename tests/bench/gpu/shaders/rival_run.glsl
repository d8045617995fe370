// SPDX-License-Identifier: Apache-2.0
// How kernels of rivals are specialised, and what an invocation takes.
#ifndef VIEWLOOM_BENCH_RIVAL_RUN_GLSL_
#define VIEWLOOM_BENCH_RIVAL_RUN_GLSL_

#include "rival_abi.h"
#include "shared/kernel_constants.h"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = kIdFree) const
    bool kWritesInvZ = false;  // of the hits, instead of colour
layout(constant_id = kIdPixelsPerInvocation) const uint kPixelsPerInvocation = 8u;
layout(constant_id = kIdLanesAreViews) const bool kLanesAreViews = true;
layout(constant_id = kIdFree + 1u) const
    bool kStoresFours = true;  // tiles are whole fours of px wide

layout(push_constant, scalar) uniform Push {
  RivalPush push;
};
// A run of px of one row of one view, and where it lies in the output.
struct Run {
  uint first_x;
  uint count;
  float tile_y;
  uint first_index;
};

// False, which no compiler knows: shaders/README.md, Loops.
bool isNever(uint loop) {
  return push.layer_count == kLayerCountMax + 1u + loop;
}

uvec2 unpackSize(uint size_px) {
  return uvec2(size_px & 0xffffu, size_px >> 16);
}

#endif  // VIEWLOOM_BENCH_RIVAL_RUN_GLSL_
