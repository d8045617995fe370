// SPDX-License-Identifier: Apache-2.0
// A px of a view, traced: its ray, the walk of that, and its colour.
#ifndef VIEWLOOM_LIB_LENS_TRACED_PX_GLSL_
#define VIEWLOOM_LIB_LENS_TRACED_PX_GLSL_

#include "lib/lens/px_view.glsl"
#include "lib/light/edge_blend.glsl"
#include "lib/light/ray_light.glsl"
#include "lib/rays/ray.glsl"
#include "lib/rays/ray_source.glsl"
#include "lib/walk/face_ray.glsl"
#include "lib/walk/ray_start.glsl"
#include "lib/walk/walk.glsl"
#include "lib/walk/walk_tasks.glsl"
#include "lib/walk/walk_views.glsl"

Seen seenOf(Scene scene, Ray ray, Walk walk, Light light, vec3 background) {
  const vec2 px_per_inv_z = ray.extent.xy / (ray.extent.z == 0.0 ? 1.0 : ray.extent.z);
  Seen seen;
  seen.color = light.is_known ? light.color.rgb : background;
  seen.inv_z = walk.is_hit ? ray.start.z + walk.t * ray.extent.z : kNoSurface;
  seen.cell = walk.cell;
  seen.layer = walk.layer;
  seen.at_sky = ray.start.xy - ray.start.z * px_per_inv_z;
  seen.px_per_inv_z = px_per_inv_z;
  seen.clean = cleanShare(scene, ray).x;
  return seen;
}

// A px of a run, traced.
struct Traced {
  Ray ray;
  Walk walk;
  ViewParams view;  // from the eye of this px
  vec3 direction;
  Seen seen;
  bool is_known;  // its colour; else the background
  bool is_used;   // else it is no px of the display
  FaceStretch stretch;  // of a face of a cube map
};

// The ray of a place of a tile, from the view's eye. `bound`: of where it may start.
Traced traceRay(Scene scene, ViewParams view, vec2 tile_px, vec3 near_eye, float bound,
                vec3 background) {
  Traced traced;
  traced.view = view;
  traced.direction = rayDirection(view, tile_px);
  const vec2 size_px = vec2(scene.extent.size_px);
  const Ray ray =
      kIsCubeFace ? makeFaceRay(near_eye, traced.direction, size_px, scene.inv_z_near,
                                traced.stretch)
      : kRaysArePlain ? makePlainRay(near_eye, traced.direction, size_px, scene.inv_z_near)
                      : makeAnyRay(near_eye, traced.direction, size_px, scene.inv_z_near);
  const WalkStart start = startOf(scene, ray, bound, kRaysArePlain);
  const WalkRules rules = WalkRules(kSeesThrough, false);
  Walk walk = walkBeside(start);
  if (ray.t_begin < ray.t_end) {
    walk = walkRay(scene, rules, ray, start, view.inv_z_tolerance, view.eye.z);
  }
  if (kLooksBehind && (view.shows & kShowsBehind) != 0u) walk = walkBehind(scene, view, ray, walk);
  Light light;
  if (kIsLayered)
    light = layeredLight(scene, view, ray, walk, background);
  else
    light = opaqueLight(scene, ray, walk);
  traced.ray = ray;
  traced.walk = walk;
  traced.seen = seenOf(scene, ray, walk, light, background);
  traced.is_known = light.is_known;
  return traced;
}

// From an eye that no other ray has.
Traced traceFromOwnEye(Scene scene, ViewParams view, vec2 tile_px, vec3 background) {
  if (kEyesInPlane) view.eye.z = 0.0;
  const vec3 near_eye = view.eye * scene.inv_z_near;
  const vec3 direction = rayDirection(view, tile_px);
  const float bound = boundBetween(scene, near_eye, direction, direction);
  return traceRay(scene, view, tile_px, near_eye, bound, background);
}

Traced tracePixel(Scene scene, ViewParams view, Run run, uint i, vec3 near_eye, float bound,
                  vec3 background) {
  const Aim aim = aimOf(vec2(float(run.first_x + i) + 0.5, run.tile_y), kRays);
  view = viewOfPx(view, aim, uvec2(run.first_x + i, uint(run.tile_y)), kRays, kThroughLens);
  Traced traced;
  if (kHasOwnEyes)
    traced = traceFromOwnEye(scene, view, aim.tile_px, background);
  else
    traced = traceRay(scene, view, aim.tile_px, near_eye, bound, background);
  traced.is_used = aim.is_used;
  return traced;
}

#endif  // VIEWLOOM_LIB_LENS_TRACED_PX_GLSL_
