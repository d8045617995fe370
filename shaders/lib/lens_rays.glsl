// SPDX-License-Identifier: Apache-2.0
// Many rays of a px through a lens, and where they meet a plane: what depends on the px alone is
// worked out once.
#ifndef VIEWLOOM_LIB_LENS_RAYS_GLSL_
#define VIEWLOOM_LIB_LENS_RAYS_GLSL_

#include "shared/trace_abi.h"

// 1/m: of planes no further than 1e20 m. No product with px overflows.
const float kTowardsMin = 1e-20;

// The plane of a sheet as a linear function g of homogeneous image coordinates: g(P) = 1 on it,
// less in front of it. Of the parts of rays.
struct PlaneParts {
  float eye;
  float direction;
  float dx;
  float dy;
};

PlaneParts partsOf(vec3 plane, ViewParams view, vec3 direction) {
  return PlaneParts(dot(plane, view.eye), dot(plane, direction), dot(plane, view.direction_dx),
                    dot(plane, view.direction_dy));
}

// A ray of the px: through a point of the lens (as px of the tile for each 1/m) and beside the
// middle of the px.
struct LensRay {
  vec2 lens_px_m;
  vec2 beside_px;
};

// Steps of a px of the tile that a ray makes by the lens are up, and rows run down.
vec3 eyeOf(ViewParams view, LensRay ray) {
  return view.eye + ray.lens_px_m.x * view.direction_dx - ray.lens_px_m.y * view.direction_dy;
}

vec3 directionOf(ViewParams view, vec3 direction, LensRay ray) {
  const vec2 step_px =
      ray.beside_px - view.lens_inv_focus * vec2(ray.lens_px_m.x, -ray.lens_px_m.y);
  return direction + step_px.x * view.direction_dx + step_px.y * view.direction_dy;
}

// Depth along the view's axis at which the ray meets the plane from the front, m; < 0: nowhere.
// What is infinitely far away, and planes that the ray never comes to, are met out there.
float depthAt(PlaneParts parts, ViewParams view, LensRay ray) {
  const vec2 step_px =
      ray.beside_px - view.lens_inv_focus * vec2(ray.lens_px_m.x, -ray.lens_px_m.y);
  const float in_front =
      1.0 - parts.eye - (ray.lens_px_m.x * parts.dx - ray.lens_px_m.y * parts.dy);
  const float towards = parts.direction + step_px.x * parts.dx + step_px.y * parts.dy;
  return in_front > 0.0 ? in_front / max(towards, kTowardsMin) : -1.0;
}

// Over the px, as the walked ones are: the first axes of Roberts' R4 sequence.
vec2 besideOf(uint point) {
  return fract(0.5 + float(point) * vec2(0.8566748838545029, 0.7338918566271260)) - 0.5;
}

#endif  // VIEWLOOM_LIB_LENS_RAYS_GLSL_
