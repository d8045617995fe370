// SPDX-License-Identifier: Apache-2.0
// What a px shows of what its ray found.
#ifndef VIEWLOOM_BENCH_RIVAL_LIGHT_GLSL_
#define VIEWLOOM_BENCH_RIVAL_LIGHT_GLSL_

#include "lib/ray.glsl"
#include "rival_source.glsl"

// Of a hit. Without one: the place whose colour goes on.
struct Found {
  bool is_hit;
  bool is_hidden;  // no hit, and behind some surface at the end
  float t;
  float middle_t;  // inside the px hit, where `t` may be on its edge
  uint layer;
};

const float kNotPassed = 2.0;  // beyond every ray

// A miss continues the surface before the silhouette that the ray first passed behind, half a px
// away from it; or the image's border, or shows the background.
uint codeOf(Ray ray, Found found) {
  const vec2 point = ray.start.xy + found.t * ray.extent.xy;
  const vec2 middle = ray.start.xy + found.middle_t * ray.extent.xy;
  const ivec2 cell = ivec2(clamp(middle, vec2(0.0), vec2(sourceSize() - 1)));
  const vec3 codes = codesFromLight(lightAt(found.layer, cell, point));
  const bool is_border = !ray.is_endless && (push.fill & kFillBorder) != 0u;
  const bool is_known = found.is_hit || found.is_hidden || is_border;
  return is_known ? packCodes(codes) : push.fill | kOpaqueCode;
}

Ray rayOf(ViewParams view, vec2 tile_px) {
  return makePlainRay(view.eye * push.inv_z_near, rayDirection(view, tile_px), vec2(sourceSize()),
                      push.inv_z_near);
}

#endif  // VIEWLOOM_BENCH_RIVAL_LIGHT_GLSL_
