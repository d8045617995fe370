// SPDX-License-Identifier: Apache-2.0
// Answers of one of several sources, or of a face of a cube map, to the reflected rays of a piece
// of a band: an invocation a px. merge_paths.comp makes one of all answers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"
#include "shared/reflection_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = kIdColorFormat) const uint kColorFormat = kColorRgba8;
layout(constant_id = kIdColorIsScaled) const bool kColorIsScaled = false;
layout(constant_id = kIdIsCubeFace) const bool kIsCubeFace = false;
layout(push_constant, scalar) uniform Push {
  TracePush push;
};

layout(set = 0, binding = kBindingPaths, scalar) readonly buffer Paths {
  ReflectedPath paths[];
};
layout(set = 0, binding = kBindingBand, scalar) writeonly buffer Answers {
  RayAnswer answers[];
};

#include "lib/mirrors/settings.glsl"
#include "lib/mirrors/mirrored_path.glsl"
#include "lib/mirrors/passed_body.glsl"
#include "lib/rays/extras.glsl"
#include "lib/walk/pushed_scene.glsl"
#include "lib/light/ray_light.glsl"
#include "lib/walk/ray_start.glsl"

// Where a ray starts as this source sees it.
struct Beginning {
  vec3 from;  // homogeneous image coordinates, m
  // On a surface of this source: of its layer, in front of it or behind; kStateUnknown: elsewhere
  uint behind_count;
  ivec2 cell;
};

// From a surface of this source, in front of it by what that may be off.
Beginning beginOn(Spot spot, float surface_error) {
  return Beginning(startBefore(spot, surface_error), spot.layer, spot.cell);
}

// From a surface of another source, which this one may know, too: then it is that which the ray
// starts from, before it or behind.
Beginning beginBeside(Scene scene, Pinhole pinhole, ReflectedPath path, vec3 direction, vec3 eye) {
  const vec3 at_m = pointFromFirst(path.start);
  const vec3 from = homogeneousPx(pinhole, at_m);
  const Beginning elsewhere = Beginning(from, kStateUnknown, ivec2(0));
  const float margin_px = kIsCubeFace ? float(kCubeApron_px) : 0.0;
  const bool is_seen =
      all(greaterThanEqual(insideOf(from, vec2(scene.extent.size_px), margin_px), vec4(0.0)));
  if (!is_seen || from.z <= 0.0) return elsewhere;
  const vec3 point = vec3(from.xy, 1.0) / from.z;
  const Spot spot = spotAt(scene, point);
  const float kappa = stepAt(scene.kappa, spot.point.z);
  const float apart = min(max(kappa, path.apart_m * point.z * point.z),
                          kToleranceShareMax * point.z);
  const uvec2 facet = loadFacet(scene.layers, spot.layer, scene.extent, spot.cell);
  if (facetInvZ(facet) < 0.0 || abs(spot.point.z - point.z) > apart) return elsewhere;
  const vec3 normal = normalOfSlopes(pinhole, unpackSlopes(facet.y), spot.point);
  if (dot(normal, direction) <= 0.0) return Beginning(from, spot.layer + 1u, spot.cell);
  const float error = surfaceError(scene, pinhole, spot, eye, path.moved_px);
  return beginOn(spot, max(error, point.z - spot.point.z));
}

// 1 / m along the ray from where it starts: never less than nothing, and no more than at the start.
float placeAlong(float inv_s, bool is_start) {
  return is_start || !(inv_s >= 0.0) ? kAtEye : min(inv_s, kAtEye);
}

// View from where the ray starts. Its pixels are those of the view, which stands behind the mirror.
ViewParams viewAlong(Pinhole pinhole, vec3 from, vec3 along, vec3 direction, float px_angle) {
  const mat3 axes = basisAround(direction);
  ViewParams view;
  view.eye = from;
  view.direction = along;
  view.direction_dx = px_angle * homogeneousPx(pinhole, axes[0]);
  view.direction_dy = px_angle * homogeneousPx(pinhole, axes[1]);
  return view;
}

// Came into the image behind a surface, and stayed there: what it met before, this source does not
// know.
bool isLost(ReflectedPath path, Walk walk) {
  return !walk.is_hit && walk.ends_behind && walk.far_axis == kAxisNone &&
         path.walk != settings.walk;
}

RayAnswer answerTo(Scene scene, Pinhole pinhole, ReflectedPath path) {
  const vec3 direction = directionFromFirst(path.direction);
  const vec3 eye = pointFromFirst(path.eye);
  Beginning beginning;
  if (path.walk == settings.walk) {
    beginning = beginOn(Spot(path.spot, columnAt(scene, path.spot.xy), path.layer),
                        path.surface_error);
  } else {
    beginning = beginBeside(scene, pinhole, path, direction, eye);
  }
  FaceStretch stretch;
  const Reflected reflected = kIsCubeFace
      ? reflectedFaceRay(scene, pinhole, beginning.from, direction, eye, path.moved_px, stretch)
      : reflectedRay(scene, pinhole, beginning.from, direction, eye, path.moved_px);
  const Ray ray = reflected.ray;
  const bool is_elsewhere = beginning.behind_count == kStateUnknown;
  const ivec2 cell =
      is_elsewhere ? columnAt(scene, ray.start.xy + ray.t_begin * ray.extent.xy) : beginning.cell;
  const WalkStart start = WalkStart(ray.t_begin, cell, beginning.behind_count);
  Walk walk = walkBeside(start);
  if (ray.t_begin < ray.t_end) {
    walk = walkRay(scene, kMeetsReflections, ray, start, reflected.inv_z_tolerance,
                   reflected.eye_z);
  }
  // A face knows no body that goes on in the next one.
  const uint body = kIsCubeFace ? kBodyUnknown : meetBody(scene, pinhole, ray, walk);
  Light light = opaqueLight(scene, ray, walk);
  light.is_known = light.is_known && !isLost(path, walk);
  if (!walk.is_hit && walk.ends_behind && light.is_known) walk.t = farSideEnd(scene, ray, walk);
  walk.is_assumed = walk.is_assumed || walk.is_back;
  const bool has_passed = walk.passed_t <= 1.0;
  const bool passed_at_start = walk.passed_t <= ray.t_begin;
  ViewParams view =
      viewAlong(pinhole, beginning.from, reflected.along, direction, path.px_angle);
  Places places = placesOf(view, reflected.along, ray, walk);
  places.hit = placeAlong(places.hit, walk.t <= ray.t_begin);
  places.passed = has_passed ? placeAlong(places.passed, passed_at_start) : kNeverPassed;
  // Nothing is unseen of a way through free space.
  if (body == kBodyPassed && walk.is_hit && !walk.is_back) places.passed = places.hit;
  // A surface as far behind the mirror as the view is before it is seen in pixels twice as wide.
  const float widened = 1.0 + distance(path.start, path.eye) * places.hit;
  view.direction_dx *= widened;
  view.direction_dy *= widened;
  const vec4 codes = vec4(codesOfBlend(light.color.rgb, kColorFormat), light.is_known ? 1.0 : 0.0);
  RayAnswer answer =
      answerOf(scene, pinhole, view, ray, reflected.along, walk, places, codes);
  if (kIsCubeFace) markFaceAnswer(answer, stretch, walk, vec2(scene.extent.size_px));
  answer.layer |= walk.is_back ? kAnswerIsBack : 0u;
  return answer;
}

void main() {
  const uint x = gl_GlobalInvocationID.x;
  if (x >= push.atlas_width_px) return;
  const uint index = gl_WorkGroupID.y * push.atlas_width_px + x;
  if (paths[index].is_on == 0u) return;
  Scene scene = pushedScene(push, false);
  addColor(scene, push.color, kColorFormat, kColorIsScaled);
  answers[index] = answerTo(scene, Pinhole(extras.focal_px, extras.principal_px), paths[index]);
}
