// SPDX-License-Identifier: Apache-2.0
// Rays of the source's image space: a straight segment in (x px, y px, inv_z), clipped to the
// frustum.
#ifndef VIEWLOOM_LIB_RAY_GLSL_
#define VIEWLOOM_LIB_RAY_GLSL_

#include "shared/trace_abi.h"

struct Ray {
  vec3 start;       // x px, y px, inv_z
  vec3 extent;      // end - start; the ray is start + t * extent, t in [0, 1]
  bool is_inside;   // false: it never sees the source's image
  // Its end lies at inv_z = 0; else it leaves the image or passes the camera plane
  bool is_endless;
};

// Direction in homogeneous image coordinates of the source.
vec3 rayDirection(ViewParams view, vec2 tile_px) {
  return view.direction + tile_px.x * view.direction_dx + tile_px.y * view.direction_dy;
}

// Keeps the part of [range.x, range.y] where (1 - u) a + u b >= 0.
void clipRange(float a, float b, inout vec2 range) {
  const float crossing = a / (a - b);
  if (a < 0.0 && b < 0.0) range.y = -1.0;
  else if (a < 0.0) range.x = max(range.x, crossing);
  else if (b < 0.0) range.y = min(range.y, crossing);
}

// The ray's points are (1 - u) eye + u direction, u in [0, 1]: u = 1 is infinitely far. Both are
// homogeneous, so every face of the frustum is one linear clip and nothing is divided before the
// end. `inv_z_near`: nothing of the source is nearer, 1/m, > 0. It also is the unit of depth here,
// so that scenes of any scale use the range of u evenly.
Ray makeRay(vec3 eye, vec3 direction, vec2 size_px, float inv_z_near) {
  const vec3 near_eye = eye * inv_z_near;
  vec2 range = vec2(0.0, 1.0);
  // Z >= 1 / inv_z_near.
  clipRange(near_eye.z - 1.0, direction.z, range);
  clipRange(near_eye.x, direction.x, range);
  clipRange(near_eye.y, direction.y, range);
  clipRange(size_px.x * near_eye.z - near_eye.x, size_px.x * direction.z - direction.x, range);
  clipRange(size_px.y * near_eye.z - near_eye.y, size_px.y * direction.z - direction.y, range);

  Ray ray;
  ray.is_inside = range.x < range.y;
  ray.is_endless = range.y == 1.0 && direction.z > 0.0;
  const vec3 from = mix(near_eye, direction, range.x);
  const vec3 to = mix(near_eye, direction, range.y);
  ray.start = vec3(from.xy, inv_z_near * (1.0 - range.x)) / from.z;
  const vec3 end = vec3(to.xy, inv_z_near * (1.0 - range.y)) / to.z;
  ray.extent = end - ray.start;
  return ray;
}

// 1/Z along the axis of the view of a point of the ray: s from point = (eye + s direction) / Z.
float viewInvZ(vec3 eye, vec3 direction, vec3 position) {
  // Z(s) = eye.z + s direction.z, and Z x(s) = eye.x + s direction.x; the larger divisor is the
  // safer.
  const vec3 divisors = abs(vec3(direction.x - position.x * direction.z,
                                 direction.y - position.y * direction.z, direction.z));
  if (position.z <= 0.0) return 0.0;
  if (divisors.z * position.z >= max(divisors.x, divisors.y) * 1e-4) {
    return position.z * direction.z / (1.0 - eye.z * position.z);
  }
  const bool use_x = divisors.x >= divisors.y;
  const float s = use_x ? (position.x * eye.z - eye.x) / (direction.x - position.x * direction.z)
                        : (position.y * eye.z - eye.y) / (direction.y - position.y * direction.z);
  return s > 0.0 ? 1.0 / s : 0.0;
}

#endif  // VIEWLOOM_LIB_RAY_GLSL_
