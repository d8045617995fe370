// SPDX-License-Identifier: Apache-2.0
// Answer of one source to a ray, comparable with those of others (shaders/walk.md, Several
// sources).
#ifndef VIEWLOOM_LIB_WALK_RAY_ANSWER_GLSL_
#define VIEWLOOM_LIB_WALK_RAY_ANSWER_GLSL_

#include "lib/rays/ray.glsl"
#include "lib/walk/walk.glsl"

// Pinhole of a source; px of its depth planes.
struct Pinhole {
  vec2 focal_px;
  vec2 principal_px;
};

// Homogeneous image coordinates (px * Z, px * Z, Z) in metres, y down.
vec3 metricPoint(Pinhole pinhole, vec3 point) {
  return vec3((point.xy - pinhole.principal_px * point.z) / pinhole.focal_px, point.z);
}

// Px of the source per px of the view, in area, on the plane through a hit with the slopes of its
// facet. In image coordinates around the hit, the plane is g P = 1 with g = (slope, inv_z), and the
// ray meets it in P = eye + s direction; so a step along the tile moves the hit in the image by s /
// Z (d - direction (g d) / (g direction)). Across the line of sight, the direction is what the eye
// lies beside it, over s: nothing at infinity, nor from the place of the source.
float samplingDensity(ViewParams view, vec3 direction, vec2 slope, vec3 point, float z_per_s,
                      float view_inv_z) {
  const vec3 along = vec3((point.xy * view.eye.z - view.eye.xy) * view_inv_z, direction.z);
  const vec3 step_x =
      vec3(view.direction_dx.xy - point.xy * view.direction_dx.z, view.direction_dx.z);
  const vec3 step_y =
      vec3(view.direction_dy.xy - point.xy * view.direction_dy.z, view.direction_dy.z);
  const vec3 g = vec3(slope, point.z);
  const float towards = dot(g, along);
  const float share = abs(towards) > 1e-30 ? 1.0 / towards : 0.0;
  const vec2 moved_x = step_x.xy - along.xy * (dot(g, step_x) * share);
  const vec2 moved_y = step_y.xy - along.xy * (dot(g, step_y) * share);
  return abs(moved_x.x * moved_y.y - moved_x.y * moved_y.x) / max(z_per_s * z_per_s, 1e-30);
}

// How much the colour of a hit counts among others: the less the nearer the source looks from the
// side of the view, and the fewer samples it has there; more samples than px are worth no more.
float colorWeight(Pinhole pinhole, ViewParams view, vec3 point, float density) {
  const vec3 from_source = metricPoint(pinhole, vec3(point.xy, 1.0));
  const vec3 from_view = from_source - point.z * metricPoint(pinhole, view.eye);
  // A ray may hit where it begins.
  const vec3 to_view = from_view * inversesqrt(max(dot(from_view, from_view), 1e-30));
  const vec3 turn = normalize(from_source) - to_view;
  return clamp(density, kDensityMin, 1.0) / (dot(turn, turn) + kAngleMin_rad * kAngleMin_rad);
}

// Where the ray enters the image, also where that is nearer than anything the source has: from
// there on the source has seen what is free. kKnownNowhere where it begins inside. The ray's points
// are eye + s direction.
float entryInvZ(ViewParams view, vec3 direction, vec2 size_px) {
  const vec4 eye_in = insideOf(view.eye, size_px, 0.0);
  const vec4 comes_in = max(insideOf(direction, size_px, 0.0), vec4(0.0));
  const vec4 entry = mix(vec4(kKnownNowhere), comes_in / max(-eye_in, vec4(1e-30)),
                         lessThan(eye_in, vec4(0.0)));
  return min(min(entry.x, entry.y), min(entry.z, entry.w));
}

uint classOf(Walk walk) {
  const uint hit = walk.is_assumed ? kClassHitAssumed : kClassHit;
  const uint no_hit = walk.ends_behind ? kClassHidden : walk.leaves ? kClassOutside : kClassEmpty;
  return walk.is_hit ? hit : no_hit;
}

// Where a ray hits, or its source knows it no further, and where it first passed behind a surface:
// 1/Z of the view.
struct Places {
  float hit;
  float passed;  // kNeverPassed
};

Places placesOf(ViewParams view, vec3 direction, Ray ray, Walk walk) {
  const vec3 point = ray.start + walk.t * ray.extent;
  const vec3 passed = ray.start + walk.passed_t * ray.extent;
  return Places(viewInvZ(view.eye, direction, point),
                walk.passed_t <= 1.0 ? viewInvZ(view.eye, direction, passed) : kNeverPassed);
}

// `light`: codes 0..255 before they are rounded, and whether they are known.
RayAnswer answerOf(Scene scene, Pinhole pinhole, ViewParams view, Ray ray, vec3 direction,
                   Walk walk, Places places, vec4 light) {
  const vec3 point = ray.start + walk.t * ray.extent;
  const bool is_seen = ray.t_begin < ray.t_end;
  const uvec2 facet = loadFacet(scene.layers, walk.layer, scene.extent, walk.cell);
  RayAnswer answer;
  answer.ray_class = classOf(walk);
  answer.layer = walk.layer;
  answer.visits = walk.visits;
  answer.view_inv_z = places.hit;
  // An error of kappa in the source's 1/Z is kappa Z^2 metres, and as far in the view.
  const float z_per_s = point.z > 0.0 ? answer.view_inv_z / point.z : abs(direction.z);
  const float kappa = stepAt(scene.kappa, point.z);
  answer.tolerance = min(kappa * z_per_s * z_per_s, kToleranceShareMax * answer.view_inv_z);
  // A ray that is never seen is known nowhere.
  answer.entry_inv_z =
      is_seen ? entryInvZ(view, direction, vec2(scene.extent.size_px)) : kNeverPassed;
  answer.passed_inv_z = places.passed;
  if (!is_seen) answer.view_inv_z = kKnownNowhere;
  const float density = samplingDensity(view, direction, unpackSlopes(facet.y), point, z_per_s,
                                        answer.view_inv_z);
  answer.weight = walk.is_hit ? colorWeight(pinhole, view, point, density) : 0.0;
  answer.light = uvec2(packHalf2x16(light.rg), packHalf2x16(light.ba));
  answer.x_px = point.x;
  answer.y_px = point.y;
  answer.inv_z = point.z;
  return answer;
}

#endif  // VIEWLOOM_LIB_WALK_RAY_ANSWER_GLSL_
