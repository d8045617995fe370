// SPDX-License-Identifier: Apache-2.0
// How kernels of rivals are specialised, and what an invocation takes.
#ifndef VIEWLOOM_BENCH_RIVAL_RUN_GLSL_
#define VIEWLOOM_BENCH_RIVAL_RUN_GLSL_

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = 0) const bool kWritesInvZ = false;  // of the hits, instead of colour
layout(constant_id = 1) const uint kPixelsPerInvocation = 8u;
layout(constant_id = 2) const bool kLanesAreViews = true;
layout(constant_id = 3) const bool kStoresFours = true;  // tiles are whole fours of px wide

// A run of px of one row of one view, and where it lies in the output.
struct Run {
  uint first_x;
  uint count;
  float tile_y;
  uint first_index;
};

#endif  // VIEWLOOM_BENCH_RIVAL_RUN_GLSL_
