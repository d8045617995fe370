// SPDX-License-Identifier: Apache-2.0
// Rays of a px through a lens, and where they meet planes.
#ifndef VIEWLOOM_LIB_LENS_LENS_RAYS_GLSL_
#define VIEWLOOM_LIB_LENS_LENS_RAYS_GLSL_

#include "shared/trace_abi.h"

// 1/m: of planes no further than 1e20 m. No product with px overflows.
const float kTowardsMin = 1e-20;

// From the eye on, homogeneous px of the source for a metre along the view's axis.
struct LensRay {
  vec3 eye;
  vec3 direction;
};

// Ray of a pixel whose middle ray goes along `direction`. It passes through a point of the lens,
// given as px of the tile for each 1/m, and beside the middle of the pixel. The lens's up is up,
// and rows run down.
LensRay makeLensRay(ViewParams view, vec3 direction, vec2 lens_px_m, vec2 beside_px) {
  const vec2 moved_px = vec2(lens_px_m.x, -lens_px_m.y);
  const vec2 step_px = beside_px - view.lens_inv_focus * moved_px;
  return LensRay(view.eye + moved_px.x * view.direction_dx + moved_px.y * view.direction_dy,
                 direction + step_px.x * view.direction_dx + step_px.y * view.direction_dy);
}

// Where the ray meets a plane of 1/Z from the front, in homogeneous px of the source; z < 0:
// nowhere. The plane is a linear function of such px that is 1 on it, less in front of it. What is
// infinitely far away, and planes that the ray never comes to, are met out there.
vec3 meets(vec3 plane, LensRay ray) {
  const float in_front = 1.0 - dot(plane, ray.eye);
  const float towards = max(dot(plane, ray.direction), kTowardsMin);
  return in_front > 0.0 ? towards * ray.eye + in_front * ray.direction : vec3(-1.0);
}

// Over the px, as the walked ones are: the first axes of Roberts' R4 sequence.
vec2 besideOf(uint point) {
  return fract(0.5 + float(point) * vec2(0.8566748838545029, 0.7338918566271260)) - 0.5;
}

#endif  // VIEWLOOM_LIB_LENS_LENS_RAYS_GLSL_
