// SPDX-License-Identifier: Apache-2.0
// Rays of the source's image space: a straight segment in (x px, y px, inv_z), clipped to the
// frustum.
#ifndef VIEWLOOM_LIB_RAYS_RAY_GLSL_
#define VIEWLOOM_LIB_RAYS_RAY_GLSL_

#include "shared/trace_abi.h"

struct Ray {
  vec3 start;   // x px, y px, inv_z
  vec3 extent;  // the ray is start + t * extent
  vec2 pace;    // t for a px, >= 0; along an axis that it does not move on, edges are out of reach
  float t_begin;  // of the part within the frustum
  float t_end;    // <= t_begin: it never sees the source's image
  // Its end lies at inv_z = 0; else it leaves the image or passes the camera plane
  bool is_endless;
};

// Direction in homogeneous image coordinates of the source.
vec3 rayDirection(ViewParams view, vec2 tile_px) {
  return view.direction + tile_px.x * view.direction_dx + tile_px.y * view.direction_dy;
}

// How far a homogeneous point is inside of four sides, `px` within the whole image: left, top,
// right, bottom.
vec4 insideOf(vec3 point, vec2 size_px, float px) {
  return vec4(point.xy - px * point.z, (size_px - px) * point.z - point.xy);
}

vec2 paceOf(vec2 extent) {
  return 1.0 / max(abs(extent), vec2(1e-30));
}

// Keeps the part of [range.x, range.y] where (1 - u) a + u b >= 0.
void clipRange(float a, float b, inout vec2 range) {
  const float crossing = a / (a - b);
  if (a < 0.0 && b < 0.0)
    range.y = -1.0;
  else if (a < 0.0)
    range.x = max(range.x, crossing);
  else if (b < 0.0)
    range.y = min(range.y, crossing);
}

// The ray's points are (1 - u) eye + u direction, u in [0, 1]: u = 1 is infinitely far. Both are
// homogeneous, so every face of the frustum is one linear clip and nothing is divided before the
// end. `near_eye`: eye * inv_z_near, where nothing of the source is nearer than inv_z_near, 1/m, >
// 0. That also is the unit of depth here, so that scenes of any scale use the range of u evenly.
Ray makeAnyRay(vec3 near_eye, vec3 direction, vec2 size_px, float inv_z_near) {
  vec2 range = vec2(0.0, 1.0);
  // Z >= 1 / inv_z_near.
  clipRange(near_eye.z - 1.0, direction.z, range);
  clipRange(near_eye.x, direction.x, range);
  clipRange(near_eye.y, direction.y, range);
  clipRange(size_px.x * near_eye.z - near_eye.x, size_px.x * direction.z - direction.x, range);
  clipRange(size_px.y * near_eye.z - near_eye.y, size_px.y * direction.z - direction.y, range);

  const vec3 from = mix(near_eye, direction, range.x);
  const vec3 to = mix(near_eye, direction, range.y);
  const vec3 start = vec3(from.xy, inv_z_near * (1.0 - range.x)) / from.z;
  const vec3 end = vec3(to.xy, inv_z_near * (1.0 - range.y)) / to.z;
  return Ray(start, end - start, paceOf((end - start).xy), 0.0, range.x < range.y ? 1.0 : 0.0,
             range.y == 1.0 && direction.z > 0.0);
}

// Whether a ray is plain (shared/trace_abi.h). What lies between two plain rays is plain.
bool isPlainRay(vec3 near_eye, vec3 direction) {
  const vec2 extent_px = direction.xy * near_eye.z - near_eye.xy * direction.z;
  return near_eye.z < 1.0 && direction.z > 0.0 &&
         max(abs(extent_px.x), abs(extent_px.y)) < kPlainExtentMax_px * direction.z;
}

// Most rays: in image space they lead from the image of the point at the near bound to the
// vanishing point, and are clipped there.
Ray makePlainRay(vec3 near_eye, vec3 direction, vec2 size_px, float inv_z_near) {
  const vec2 vanishing = direction.xy * (1.0 / direction.z);
  const vec2 extent = vanishing * near_eye.z - near_eye.xy;
  const vec2 start = vanishing - extent;
  const vec2 pace = paceOf(extent);
  const bvec2 goes_back = lessThan(extent, vec2(0.0));
  const vec2 behind_px = mix(start, size_px - start, goes_back);
  const vec2 ahead_px = mix(size_px - start, start, goes_back);
  const vec2 t_in = -behind_px * pace;
  const vec2 t_out = ahead_px * pace;
  const float t_end = min(min(t_out.x, t_out.y), 1.0);
  return Ray(vec3(start, inv_z_near), vec3(extent, -inv_z_near), pace,
             max(max(t_in.x, t_in.y), 0.0), t_end, t_end == 1.0);
}

// 1/Z along the axis of the view of a point of the ray: 1/s of point = (eye + s direction) / Z.
// Each coordinate says it as a quotient of differences; taken is the one that loses the fewest bits
// where these cancel. At an eye far in front of what it sees, or in the source's plane, that is
// 1/Z; close to a surface, or where the view looks along that plane, x or y.
float viewInvZ(vec3 eye, vec3 direction, vec3 position) {
  if (position.z <= 0.0) return 0.0;
  const float part_z = eye.z * position.z;
  const vec2 part_direction = position.xy * direction.z;
  const vec2 part_eye = position.xy * eye.z;
  const float rest_z = 1.0 - part_z;
  const vec2 rest_direction = direction.xy - part_direction;
  const vec2 rest_eye = part_eye - eye.xy;
  const float loss_z = (1.0 + abs(part_z)) / max(abs(rest_z), 1e-30);
  const vec2 loss = (abs(direction.xy) + abs(part_direction)) / max(abs(rest_direction), 1e-30) +
                    (abs(eye.xy) + abs(part_eye)) / max(abs(rest_eye), 1e-30);
  if (loss_z <= min(loss.x, loss.y)) return position.z * direction.z / rest_z;
  const vec2 inv_z = rest_direction / rest_eye;
  return max(loss.x <= loss.y ? inv_z.x : inv_z.y, 0.0);
}

#endif  // VIEWLOOM_LIB_RAYS_RAY_GLSL_
