// SPDX-License-Identifier: Apache-2.0
// Hi-Z (Uludag, "Hi-Z Screen-Space Cone-Traced Reflections", GPU Pro 5; AMD's SSSR): a walk of a
// min/max pyramid that goes up where a box is passed and down where it is met, over one layer after
// the other. A px is hit as in dda_views.comp. A ray that runs out of steps is a miss.
//
// Tried with 8 px an invocation, CPU ns a ray of the synthetic quilt with a cone of 2 | 7 degrees
// on lavapipe, before boxes were packed, 2026-11-21: two levels at a time, as here, 18.0 | 27.6;
// one level at a time 19.4 | 28.8; up whatever the parent 19.5 | 32.0; from the largest inv_z of
// the source instead of that around a run 27.8 | 39.0. Two texels a box 18.2 | 26.6, one 18.9 |
// 26.6, whose build takes 12 ms instead of 15.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"

#include "boxes.glsl"
#include "rival_light.glsl"

const uint kStepsMax = 512u;  // of one layer
const uint kLevelStart = 2u;

// Layer l + 1 lies behind layer l: it is walked only from where the ray first was behind that one.
// Rays are mirrored so that they go up along x and y, as in lib/walk/walk.glsl.
Found findHit(Ray ray, float bound) {
  const ivec2 size_px = sourceSize();
  const uvec2 padded_px = paddedSize(uvec2(size_px));
  const bvec2 goes_back = lessThan(ray.extent.xy, vec2(0.0));
  const ivec2 flip = mix(ivec2(0), ivec2(-1), goes_back);
  const vec2 start_px = mix(ray.start.xy, -ray.start.xy, goes_back);
  const vec2 extent_px = abs(ray.extent.xy);
  const ivec2 last_cell = (size_px - 1) | flip;
  float stop_t = ray.t_end;
  float begin_t = clamp((bound - ray.start.z) / ray.extent.z, ray.t_begin, ray.t_end);
  Found found = Found(false, false, ray.t_end, ray.t_end, 0u);
  uint layer = 0u;
  for (;;) {
    if (isNever(1u)) break;
    const vec2 begin = ray.start.xy + begin_t * ray.extent.xy;
    ivec2 cell = ivec2(clamp(begin, vec2(0.0), vec2(size_px - 1))) ^ flip;
    float enter_t = begin_t;
    float exit_t = begin_t;
    vec2 box = vec2(0.0);
    float passed_t = kNotPassed;
    bool meets = false;
    uint level = kLevelStart;
    uint step_count = 0u;
    for (;;) {
      if (isNever(2u)) break;
      const uvec2 block = uvec2(cell ^ flip) >> level;
      const uint at = layer * push.box_stride + boxIndex(padded_px, level, block);
      box = boxOfWord(texelFetch(box_texels, int(at)).x, level, push.kappa);
      const ivec2 end_cell = cell | ((1 << level) - 1);
      const vec2 edge_t = (vec2(end_cell + 1) - start_px) * ray.pace;
      const bool cross_x = edge_t.x <= edge_t.y;
      exit_t = min(max(min(edge_t.x, edge_t.y), enter_t), stop_t);
      const float enter_inv_z = ray.start.z + enter_t * ray.extent.z;
      const float exit_inv_z = ray.start.z + exit_t * ray.extent.z;
      const bool is_behind = enter_inv_z < box.x && exit_inv_z <= box.y;
      const bool skips = is_behind || exit_inv_z > box.y;
      passed_t = is_behind ? min(passed_t, enter_t) : passed_t;
      // Cells never go back, whatever the rounding.
      const ivec2 inside = clamp(ivec2(floor(start_px + exit_t * extent_px)), cell, end_cell);
      const ivec2 next = mix(inside, end_cell + 1, bvec2(cross_x, !cross_x));
      meets = !skips && level == 0u;
      ++step_count;
      const bool ends = skips && (exit_t >= stop_t || any(greaterThan(next, last_cell)));
      const bool is_done = meets || ends || step_count == kStepsMax;
      const bool same_parent = all(equal(cell >> int(level + 2u), next >> int(level + 2u)));
      const uint up = same_parent ? level : min(level + 2u, kBoxLevelLast);
      const uint down = level == 0u ? 0u : level - 2u;
      level = skips ? up : down;
      cell = mix(cell, next, bvec2(skips));
      enter_t = skips && !is_done ? exit_t : enter_t;
      if (is_done) break;
    }
    finishLayer(ray, layer, meets, box.y, enter_t, exit_t, passed_t, found, stop_t);
    begin_t = passed_t;
    ++layer;
    if (passed_t == kNotPassed || layer >= push.layer_count) break;
  }
  return found;
}

// The largest inv_z where the rays of a run pass, as in lib/walk/ray_start.glsl.
const uint kBoundLevel = 5u;
const int kBoundCellsMax = 16;
const float kBoundMargin = 16.0 / 8388608.0;

float boundOfRun(ViewParams view, Run run) {
  const ivec2 size_px = sourceSize();
  const Ray first = rayOf(view, vec2(float(run.first_x) + 0.5, run.tile_y));
  const Ray last = rayOf(view, vec2(float(run.first_x + run.count) - 0.5, run.tile_y));
  const vec2 first_end = first.start.xy + first.extent.xy;
  const vec2 last_end = last.start.xy + last.extent.xy;
  const vec2 low_px = min(min(first.start.xy, last.start.xy), min(first_end, last_end));
  const vec2 high_px = max(max(first.start.xy, last.start.xy), max(first_end, last_end));
  const vec2 limit_px = vec2(size_px - 1);
  const ivec2 first_cell = ivec2(clamp(low_px, vec2(0.0), limit_px)) >> int(kBoundLevel);
  const ivec2 last_cell = ivec2(clamp(high_px, vec2(0.0), limit_px)) >> int(kBoundLevel);
  const ivec2 count = last_cell - first_cell + 1;
  if (count.x * count.y > kBoundCellsMax) return push.inv_z_near;
  const uvec2 padded_px = paddedSize(uvec2(size_px));
  float bound = 0.0;
  ivec2 cell = first_cell;
  for (;;) {
    if (isNever(3u)) break;
    const uint word = texelFetch(box_texels, int(boxIndex(padded_px, kBoundLevel, cell))).x;
    bound = max(bound, boxOfWord(word, kBoundLevel, vec3(0.0)).y);
    cell = cell.x == last_cell.x ? ivec2(first_cell.x, cell.y + 1) : ivec2(cell.x + 1, cell.y);
    if (cell.y > last_cell.y) break;
  }
  return min(bound + kBoundMargin * push.inv_z_near, push.inv_z_near);
}

uint pixelOf(ViewParams view, Run run, uint i, float bound) {
  const Ray ray = rayOf(view, vec2(float(run.first_x + i) + 0.5, run.tile_y));
  Found found = Found(false, false, 1.0, 1.0, 0u);  // never sees the image: its border, from afar
  if (ray.t_begin < ray.t_end) found = findHit(ray, bound);
  if (kWritesInvZ) {
    return floatBitsToUint(found.is_hit ? ray.start.z + found.t * ray.extent.z : kNoSurface);
  }
  return codeOf(ray, found);
}

#include "rival_views.glsl"
