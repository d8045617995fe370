// SPDX-License-Identifier: Apache-2.0
// The body behind whose silhouette a ray passes: how far back it is taken to reach, and whether the
// ray meets it there (shaders/reflections.md).
#ifndef VIEWLOOM_LIB_MIRRORS_PASSED_BODY_GLSL_
#define VIEWLOOM_LIB_MIRRORS_PASSED_BODY_GLSL_

#include "lib/mirrors/mirror.glsl"

// A body whose other rim is further away is not looked at.
const int kBodyReach_px = 128;
// From one place where a ray is looked at to the next, as a share of its way behind the body; but
// no less than the second. The body bends most beside its rim.
const float kBodyStepShare = 0.25;
const float kBodyStepMin_px = 0.5;
// The rim of what is round lies before the next sample; what comes out beyond by more has an edge.
const float kRoundMax_px = 1.25;

// Where a body ends.
struct Rim {
  float px;  // along the body
  float inv_z;
  bool is_round;  // turns away there; else it has an edge
};

// From rim to rim, along the ray's picture or an axis of the image. Places are px from where the
// ray passed behind it.
struct PassedBody {
  bool is_whole;  // else nothing is known
  vec2 edge_px;   // where the ray passed
  vec2 along;     // one px, along one axis of the image
  Rim near_rim;
  Rim far_rim;
  float last_px;  // the last sample before the far rim
  float last_inv_z;
};

// Body of the first layer.
float bodyAt(Scene scene, vec2 at_px) {
  const ivec2 cell = ivec2(clamp(floor(at_px), vec2(0.0), vec2(scene.extent.size_px - 1)));
  const uvec2 facet = loadFacet(scene.layers, 0u, scene.extent, cell);
  return facet.x == kNoFacet ? kNoSurface : facetAtPoint(facet, cell, at_px);
}

// By the samples next to a rim: the last, at last_px, and those one and two px further in;
// `outwards` is +1 or -1. What is round falls as an ellipse as long as the body does, d px from its
// rim: fall^2 = c g(d) with g = d - d^2 / length, (fall + a)^2 = c g(d + 1), (fall + a + b)^2 =
// c g(d + 2); g grows by `first`, then by `then`, if d is half a px. What does not fall so has an
// edge, half a px beyond the sample.
Rim rimBeyond(vec3 samples, float length_px, float last_px, float outwards) {
  const float a = samples.y - samples.x;
  const float b = samples.z - samples.y;
  const float first = 1.0 - 2.0 / length_px;
  const float then = 1.0 - 4.0 / length_px;
  const float bends = 2.0 * (a * then - b * first);
  const float fall = ((b + 2.0 * a) * b * first - a * a * then) / bends;
  const float grown = fall * fall * first / (a * a + 2.0 * a * fall);
  const float beyond_px = grown * (1.0 + grown / length_px);
  const bool is_round = bends > 0.0 && b > 0.0 && fall >= 0.0 && beyond_px <= kRoundMax_px;
  return Rim(last_px + outwards * (is_round ? min(beyond_px, 1.0) : 0.5),
             samples.x - (is_round ? fall : 0.5 * a), is_round);
}

// Whether a surface lies further behind a place than it is away from it: it is none of the body.
bool isBeyond(Pinhole pinhole, vec3 place, vec2 at_px, float inv_z) {
  const float way_m =
      distance(metresOf(pinhole, vec3(at_px, place.z)), metresOf(pinhole, place));
  return inv_z * (1.0 / place.z + way_m) < 1.0;
}

// How many px behind its first sample a body has its last one; -1: out of reach. At distances that
// double, then between the last two.
int bodyLength(Scene scene, Pinhole pinhole, vec2 first_px, vec2 along, float inv_z) {
  int inside = 0;
  int outside = 1;
  bool is_between = false;
  for (;;) {
    if (isNever(scene, 14u) || inv_z <= 0.0 || (is_between && outside - inside == 1)) break;
    const int at = is_between ? (inside + outside) / 2 : outside;
    const vec2 at_px = first_px + float(at) * along;
    const bool is_in_image = all(greaterThanEqual(at_px, vec2(0.0))) &&
                             all(lessThan(at_px, vec2(scene.extent.size_px)));
    const bool is_beyond =
        isBeyond(pinhole, vec3(first_px, inv_z), at_px, bodyAt(scene, at_px));
    if (!is_in_image || (!is_beyond && at >= kBodyReach_px)) break;
    is_between = is_between || is_beyond;
    inside = is_beyond ? inside : at;
    outside = is_beyond ? at : is_between ? outside : 2 * at;
  }
  return is_between ? inside : -1;
}

// Along the picture of the ray; where that finds no other rim, along the axis across which it
// passed.
PassedBody passedBody(Scene scene, Pinhole pinhole, Ray ray, float passed_t) {
  const vec3 passed = ray.start + passed_t * ray.extent;
  const vec2 off_edge = abs(passed.xy - round(passed.xy));
  const vec2 across = off_edge.x < off_edge.y ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
  PassedBody body;
  body.edge_px = passed.xy;
  body.along = ray.extent.xy * min(ray.pace.x, ray.pace.y);
  int length_px = -1;
  float first = 0.0;
  for (int way = 0; way < 2 && length_px < 0; ++way) {
    const vec2 ahead = mix(vec2(1.0), vec2(-1.0), lessThan(ray.extent.xy, vec2(0.0)));
    body.along = way == 0 ? body.along : across * ahead;
    const vec2 first_px = passed.xy + 0.5 * body.along;
    first = bodyAt(scene, first_px);
    length_px = bodyLength(scene, pinhole, first_px, body.along, first > passed.z ? first : 0.0);
  }
  const vec2 first_px = passed.xy + 0.5 * body.along;
  const vec2 last_px = first_px + float(length_px) * body.along;
  const vec2 second = float(min(length_px, 1)) * body.along;
  const vec2 third = float(min(length_px, 2)) * body.along;
  body.last_px = float(length_px) + 0.5;
  body.last_inv_z = bodyAt(scene, last_px);
  const vec3 near_samples =
      vec3(first, bodyAt(scene, first_px + second), bodyAt(scene, first_px + third));
  const vec3 far_samples =
      vec3(body.last_inv_z, bodyAt(scene, last_px - second), bodyAt(scene, last_px - third));
  body.near_rim = rimBeyond(near_samples, float(length_px + 1), 0.5, -1.0);
  body.far_rim = rimBeyond(far_samples, float(length_px + 1), body.last_px, 1.0);
  body.is_whole = length_px >= 0 && min(body.near_rim.inv_z, body.far_rim.inv_z) > 0.0;
  return body;
}

// How far in front of a body the place is that lies opposite to a place behind it, 1/m: the body's
// back is its front turned half around. About the middle between its rims: in the image, where one
// is round, as lines of sight touch both its front and its back there; else in space.
float frontOpposite(Scene scene, Pinhole pinhole, PassedBody body, vec3 place) {
  const Rim near_rim = body.near_rim;
  const Rim far_rim = body.far_rim;
  const vec2 near_px = body.edge_px + near_rim.px * body.along;
  const vec2 far_px = body.edge_px + far_rim.px * body.along;
  vec3 opposite = vec3(near_px + far_px - place.xy, near_rim.inv_z + far_rim.inv_z - place.z);
  if (!near_rim.is_round && !far_rim.is_round) {
    const vec3 opposite_m = metresOf(pinhole, vec3(near_px, near_rim.inv_z)) +
                            metresOf(pinhole, vec3(far_px, far_rim.inv_z)) -
                            metresOf(pinhole, place);
    const vec3 seen = homogeneousPx(pinhole, opposite_m);
    opposite = seen.z > 0.0 ? vec3(seen.xy, 1.0) / seen.z : vec3(near_px, 3.4e38);
  }
  const float at = dot(opposite.xy - body.edge_px, body.along) / dot(body.along, body.along);
  const float beyond = (far_rim.px - at) / (far_rim.px - body.last_px);
  const float rounded = mix(far_rim.inv_z, body.last_inv_z, sqrt(clamp(beyond, 0.0, 1.0)));
  const float front = at > body.last_px
                          ? rounded
                          : bodyAt(scene, body.edge_px + max(at, 0.5) * body.along);
  return at < near_rim.px || at > far_rim.px ? 1.0 : opposite.z - front;
}

// Whether a ray went through what a body has beyond its last sample: in front of its rim, and
// behind it a part of a px later.
bool passesThroughRim(Ray ray, float passed_t, PassedBody body) {
  const float px_t = dot(body.along, body.along) / dot(body.along, ray.extent.xy);
  const float rim_t = passed_t + body.near_rim.px * px_t;
  return body.near_rim.px < 0.0 && rim_t >= ray.t_begin &&
         ray.start.z + rim_t * ray.extent.z >= body.near_rim.inv_z;
}

// The column of the body whose colour is that of what is met at a place behind it.
ivec2 columnOfBody(Scene scene, PassedBody body, vec2 place_px) {
  const float at = dot(place_px - body.edge_px, body.along) / dot(body.along, body.along);
  const vec2 on_body = body.edge_px + clamp(at, 0.5, body.last_px) * body.along;
  return clamp(ivec2(floor(on_body)), ivec2(0), scene.extent.size_px - 1);
}

// For a walk that has passed behind something. A body that is met ends it, with the front's colour.
uint meetBody(Scene scene, Pinhole pinhole, Ray ray, inout Walk walk) {
  const bool has_passed = walk.passed_t > ray.t_begin && walk.passed_t < walk.t;
  if (!has_passed || hasFault(kFaultBodiesFlat)) return kBodyUnknown;
  const PassedBody body = passedBody(scene, pinhole, ray, walk.passed_t);
  if (!body.is_whole) return kBodyUnknown;
  const float px_t = min(ray.pace.x, ray.pace.y);
  const bool is_cut_off = passesThroughRim(ray, walk.passed_t, body);
  float at_px = 0.02;
  bool is_met = false;
  for (;;) {
    const float t = walk.passed_t + at_px * px_t;
    if (isNever(scene, 15u) || t >= walk.t || at_px > float(kBodyReach_px)) break;
    is_met = is_cut_off ||
             frontOpposite(scene, pinhole, body, ray.start + t * ray.extent) <= 0.0;
    if (is_met) break;
    at_px += max(kBodyStepShare * at_px, kBodyStepMin_px);
  }
  if (!is_met) return kBodyPassed;
  walk.is_hit = true;
  walk.is_back = true;
  walk.is_assumed = true;
  walk.t = walk.passed_t + at_px * px_t;
  walk.cell = columnOfBody(scene, body, (ray.start + walk.t * ray.extent).xy);
  walk.layer = 0u;
  walk.level = kLevelFacets;
  return kBodyMet;
}

#endif  // VIEWLOOM_LIB_MIRRORS_PASSED_BODY_GLSL_
