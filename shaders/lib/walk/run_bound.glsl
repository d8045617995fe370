// SPDX-License-Identifier: Apache-2.0
// The bound of where the rays of a run of px may start. A parameter that the kernel
// sets: kRaysArePlain.
#ifndef VIEWLOOM_LIB_WALK_RUN_BOUND_GLSL_
#define VIEWLOOM_LIB_WALK_RUN_BOUND_GLSL_

#include "lib/rays/ray.glsl"
#include "lib/walk/ray_start.glsl"
#include "lib/walk/walk_tasks.glsl"

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

// Of a run whose rays come from one eye.
float boundOfRun(Scene scene, ViewParams view, vec3 near_eye, Run run) {
  const vec3 first = rayDirection(view, vec2(float(run.first_x) + 0.5, run.tile_y));
  return boundBetween(scene, near_eye, first, first + float(run.count - 1u) * view.direction_dx);
}

#endif  // VIEWLOOM_LIB_WALK_RUN_BOUND_GLSL_
