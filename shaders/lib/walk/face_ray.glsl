// SPDX-License-Identifier: Apache-2.0
// The stretch of a ray that a face of a cube map is asked about, and what it answers
// (shaders/walk.md, Cube maps).
#ifndef VIEWLOOM_LIB_WALK_FACE_RAY_GLSL_
#define VIEWLOOM_LIB_WALK_FACE_RAY_GLSL_

#include "lib/rays/ray.glsl"
#include "lib/walk/ray_answer.glsl"
#include "lib/walk/walk.glsl"
#include "shared/cube_abi.h"

// Keeps the part from where (1 - u) a + u b >= 0 on.
void clipBegin(float a, float b, inout float begin) {
  if (a < 0.0) begin = b < 0.0 ? 2.0 : max(begin, a / (a - b));
}

// Keeps the part up to where it is no more.
void clipEnd(float a, float b, inout float end) {
  if (b < 0.0) end = a < 0.0 ? -1.0 : min(end, a / (a - b));
}

// A face's stretch of a ray, whose points are (1 - u) eye inv_z_near + u direction.
struct FaceStretch {
  float begin_inv_z;  // of the face's own px, 1/Z of the view; kNeverPassed if it is never there
  float inv_z_near;
  vec2 end_u;    // of both ends of what is walked
  vec2 per_end;  // 1 over the third part of the points there
};

// Where t of a stretch lies, 1/Z of the view: at u it is inv_z_near (1 - u) / u. By sums of what is
// not negative, as rays may run along the face's image or begin at its camera.
float placeInvZ(FaceStretch stretch, float t) {
  const vec2 share = vec2(1.0 - t, t) * stretch.per_end;
  const float along = dot(stretch.end_u, share);
  return min(stretch.inv_z_near * dot(1.0 - stretch.end_u, share) / max(along, 1e-30), kAtEye);
}

// The same as makeAnyRay, from where the ray enters the face's own pixels, to the seam beyond where
// it leaves them.
Ray makeFaceRay(vec3 near_eye, vec3 direction, vec2 size_px, float inv_z_near,
                out FaceStretch stretch) {
  const float own_px = float(kCubeApron_px) - kSeamOverlap_px;
  const vec4 eye_in = insideOf(near_eye, size_px, own_px);
  const vec4 end_in = insideOf(direction, size_px, own_px);
  const float seam_px = float(kCubeApron_px) - kSeam_px;
  const vec4 eye_in_seam = insideOf(near_eye, size_px, seam_px);
  const vec4 end_in_seam = insideOf(direction, size_px, seam_px);
  float own_begin = 0.0;
  float own_end = 1.0;
  float end = 1.0;
  for (int side = 0; side < 4; ++side) {
    clipBegin(eye_in[side], end_in[side], own_begin);
    clipEnd(eye_in[side], end_in[side], own_end);
    clipEnd(eye_in_seam[side], end_in_seam[side], end);
  }
  // (1 - u) eye inv_z_near + u direction is eye + s direction, scaled.
  const float entry_inv_z = inv_z_near * (1.0 - own_begin) / max(own_begin, 1e-30);
  // Z >= 1 / inv_z_near.
  float begin = own_begin;
  clipBegin(near_eye.z - 1.0, direction.z, begin);
  clipEnd(near_eye.z - 1.0, direction.z, end);
  const bool is_seen = own_begin < own_end && begin < end;
  begin = is_seen ? begin : 0.0;
  end = is_seen ? end : 1.0;
  const vec3 from = mix(near_eye, direction, begin);
  const vec3 to = mix(near_eye, direction, end);
  stretch.begin_inv_z = is_seen ? min(entry_inv_z, kAtEye) : kNeverPassed;
  stretch.inv_z_near = inv_z_near;
  stretch.end_u = vec2(begin, end);
  stretch.per_end = 1.0 / vec2(from.z, to.z);
  const vec3 first = vec3(from.xy, inv_z_near * (1.0 - begin)) / from.z;
  const vec3 last = vec3(to.xy, inv_z_near * (1.0 - end)) / to.z;
  return Ray(first, last - first, paceOf((last - first).xy), 0.0, is_seen ? 1.0 : 0.0,
             end == 1.0 && direction.z > 0.0);
}

// Marks the parts of an answer that have another meaning on a face.
void markFaceAnswer(inout RayAnswer answer, FaceStretch stretch, Walk walk, vec2 size_px) {
  const vec4 inside = insideOf(vec3(answer.x_px, answer.y_px, 1.0), size_px,
                               float(kCubeApron_px) - kSeamOverlap_px);
  const bool passed_edge = walk.far_axis != kAxisNone;
  // A silhouette where something is hit is not passed before.
  const bool passes = walk.passed_t <= 1.0 && (walk.is_assumed || !walk.is_hit);
  answer.entry_inv_z = stretch.begin_inv_z;
  answer.view_inv_z = placeInvZ(stretch, walk.t);
  answer.passed_inv_z = passes ? placeInvZ(stretch, walk.passed_t) : kNeverPassed;
  answer.layer |= any(lessThan(inside, vec4(0.0))) ? kAnswerInSeam : 0u;
  answer.layer |= passed_edge ? kAnswerPassedEdge : 0u;
}

#endif  // VIEWLOOM_LIB_WALK_FACE_RAY_GLSL_
