// SPDX-License-Identifier: Apache-2.0
// Frame of the rivals' kernels: the px of an invocation, as in shaders/trace/walk_views.comp, and
// how they are stored. The includer has uint pixelOf(ViewParams view, Run run, uint i, float
// bound), the colour of px i of a run; and float boundOfRun(ViewParams view, Run run), from where
// rays of a run may start.
#ifndef VIEWLOOM_BENCH_RIVAL_VIEWS_GLSL_
#define VIEWLOOM_BENCH_RIVAL_VIEWS_GLSL_

#include "rival_run.glsl"

layout(set = 0, binding = kBindingViews, scalar) readonly buffer Views {
  ViewParams views[];
};
layout(set = 0, binding = kBindingBand, scalar) writeonly buffer Band {
  uint band[];
};
layout(set = 0, binding = kBindingBand, scalar) writeonly buffer BandFours {
  uvec4 band_fours[];
};

// Four px at a time where the atlas allows it: a software device runs stores lane by lane.
void storeRun(ViewParams view, Run run) {
  const float bound = boundOfRun(view, run);
  uvec4 codes = uvec4(0u);
  uint i = 0u;
  for (;;) {
    if (isNever(5u)) break;
    const uint code = pixelOf(view, run, i, bound);
    if (kStoresFours) {
      codes = uvec4(codes.yzw, code);
      if ((i & 3u) == 3u) band_fours[(run.first_index + i) / 4u] = codes;
    } else {
      band[run.first_index + i] = code;
    }
    ++i;
    if (i == run.count) break;
  }
}

void main() {
  const uvec2 tile_size = unpackSize(push.tile_size_px);
  const uvec2 tile_grid = unpackSize(push.tile_grid);
  const uint row = push.first_row + gl_WorkGroupID.y;
  const uint invocation = gl_GlobalInvocationID.x;
  const uint runs = (tile_size.x + kPixelsPerInvocation - 1u) / kPixelsPerInvocation;
  const uint column = kLanesAreViews ? invocation % tile_grid.x : invocation / runs;
  const uint run_in_tile = kLanesAreViews ? invocation / tile_grid.x : invocation % runs;
  const uint tile_row =
      row < push.padding_top_px ? tile_grid.y : (row - push.padding_top_px) / tile_size.y;
  const bool exists = run_in_tile < runs && column < tile_grid.x && tile_row < tile_grid.y;
  const uint tile = exists ? tile_row * tile_grid.x + column : 0u;
  const ViewParams view = views[tile];
  if (!exists || view.is_used == 0u) return;
  Run run;
  run.first_x = run_in_tile * kPixelsPerInvocation;
  run.count = min(kPixelsPerInvocation, tile_size.x - run.first_x);
  run.tile_y = float(row - push.padding_top_px - tile_row * tile_size.y) + 0.5;
  run.first_index = gl_WorkGroupID.y * push.atlas_width_px + column * tile_size.x + run.first_x;
  storeRun(view, run);
}

#endif  // VIEWLOOM_BENCH_RIVAL_VIEWS_GLSL_
