// SPDX-License-Identifier: Apache-2.0
// Runs of px that invocations of trace/walk_views.comp trace, and the bound where their rays may
// start.
#ifndef VIEWLOOM_LIB_WALK_WALK_TASKS_GLSL_
#define VIEWLOOM_LIB_WALK_WALK_TASKS_GLSL_

#include "lib/rays/ray.glsl"
#include "lib/walk/ray_start.glsl"
#include "lib/rays/met_blocks.glsl"
#include "lib/walk/walk_views.glsl"

// A run of px of one row of one view, and where it lies in the band. Between two runs of a row each
// is traced with one px more, which the other stores.
struct Run {
  uint first_x;
  uint count;
  uint lead;   // px of another run at the beginning, 0 or 1
  uint trail;  // and at the end
  float tile_y;
  uint first_index;
};

// An invocation's px, if there are any, and the tile that they are of.
struct Task {
  Run run;
  uint tile;
  uint id;  // of runs of rows: which of the band
  bool exists;
};

// Runs of a row of a tile.
uint runsOfTile() {
  return (sizeOf(push.tile_size_px).x + kPixelsPerInvocation - 1u) / kPixelsPerInvocation;
}

// And of a row of the band.
uint runsOfRow() {
  return runsOfTile() * sizeOf(push.tile_grid).x;
}

Task taskOfRun(uint invocation, uint band_row) {
  const uvec2 tile_size = sizeOf(push.tile_size_px);
  const uvec2 tile_grid = sizeOf(push.tile_grid);
  const uint runs = runsOfTile();
  const uint row = push.first_row + band_row;
  const uint column = kLanesAreViews ? invocation % tile_grid.x : invocation / runs;
  const uint run_in_tile = kLanesAreViews ? invocation / tile_grid.x : invocation % runs;
  const uint tile_row =
      row < push.padding_top_px ? tile_grid.y : (row - push.padding_top_px) / tile_size.y;
  Task task;
  task.id = band_row * runsOfRow() + invocation;
  task.exists = run_in_tile < runs && column < tile_grid.x && tile_row < tile_grid.y;
  task.tile = task.exists ? tile_row * tile_grid.x + column : 0u;
  const uint first_x = run_in_tile * kPixelsPerInvocation;
  const bool has_trail = first_x + kPixelsPerInvocation < tile_size.x;
  const bool looks_for_edges = !kIsOneOfSeveral && !kHasOwnEyes;
  task.run.lead = looks_for_edges ? min(first_x, 1u) : 0u;
  task.run.trail = has_trail && looks_for_edges ? 1u : 0u;
  task.run.first_x = first_x - task.run.lead;
  task.run.count =
      min(first_x + kPixelsPerInvocation, tile_size.x) + task.run.trail - task.run.first_x;
  task.run.tile_y = float(row - push.padding_top_px - tile_row * tile_size.y) + 0.5;
  task.run.first_index =
      band_row * push.atlas_width_px + column * tile_size.x + task.run.first_x;
  return task;
}

Task taskOfBlock() {
  const BlockGrid grid = gridOf(push);
  const uint entry = gl_GlobalInvocationID.x / kMetBlockSide_px;
  const uint list = entry < incomplete.count ? incomplete_list[entry] : 0u;
  const uint per_row = blocksPerRow(grid);
  const uvec2 at_block = uvec2(list % per_row, list / per_row);
  const uvec2 tile = tileOfBlock(grid, at_block);
  const MetBlock block = metBlock(grid, at_block);
  const uint row = block.first_row + gl_GlobalInvocationID.x % kMetBlockSide_px;
  Task task;
  task.id = 0u;
  task.exists = entry < incomplete.count && row < block.end_row;
  task.tile = tile.y * grid.tile_count.x + tile.x;
  task.run.lead = 0u;
  task.run.trail = 0u;
  task.run.first_x = block.first_x - tile.x * grid.tile_size_px.x;
  task.run.count = block.end_x - block.first_x;
  const uint tile_first_row = push.padding_top_px + tile.y * grid.tile_size_px.y;
  task.run.tile_y = float(push.first_row + row - tile_first_row) + 0.5;
  task.run.first_index = row * push.atlas_width_px + block.first_x;
  return task;
}

// The bound where rays may start that lie between two. Rays between two plain ones are plain, and
// pass no cell outside the rectangle around those.
float boundBetween(Scene scene, vec3 near_eye, vec3 first, vec3 last) {
  if (!kRaysArePlain && !(isPlainRay(near_eye, first) && isPlainRay(near_eye, last))) {
    return scene.inv_z_near;
  }
  const vec2 first_end = first.xy / first.z;
  const vec2 last_end = last.xy / last.z;
  const vec2 first_start = first_end * (1.0 - near_eye.z) + near_eye.xy;
  const vec2 last_start = last_end * (1.0 - near_eye.z) + near_eye.xy;
  const vec2 low_px = min(min(first_start, last_start), min(first_end, last_end));
  const vec2 high_px = max(max(first_start, last_start), max(first_end, last_end));
  return startBound(scene, low_px, high_px);
}

// The bound of a run whose rays come from one eye.
float boundOfRun(Scene scene, ViewParams view, vec3 near_eye, Run run) {
  const vec3 first = rayDirection(view, vec2(float(run.first_x) + 0.5, run.tile_y));
  return boundBetween(scene, near_eye, first, first + float(run.count - 1u) * view.direction_dx);
}

#endif  // VIEWLOOM_LIB_WALK_WALK_TASKS_GLSL_
