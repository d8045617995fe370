// SPDX-License-Identifier: Apache-2.0
// Hits of reflected rays in the source that they start in, by its walk.
#ifndef VIEWLOOM_LIB_MIRRORS_MIRRORED_WALK_GLSL_
#define VIEWLOOM_LIB_MIRRORS_MIRRORED_WALK_GLSL_

#include "lib/mirrors/mirrored_px.glsl"
#include "lib/mirrors/passed_body.glsl"
#include "lib/mirrors/settings.glsl"

// Certainty of a ray that went on unseen, or of none where that has no end.
float certainty(Pinhole pinhole, Spot from, Ray ray, float passed_t, float hit_t) {
  const vec3 passed = ray.start + passed_t * ray.extent;
  const vec3 hit = ray.start + hit_t * ray.extent;
  if (passed.z <= 0.0 || hit.z <= 0.0) return 0.0;
  const float unseen_m = distance(metresOf(pinhole, hit), metresOf(pinhole, passed));
  return certaintyOf(unseen_m, from.point.z);
}

Walk walkMirrored(Scene scene, Spot from, Reflected reflected) {
  const Ray ray = reflected.ray;
  const uint behind_count = from.layer + (hasFault(kFaultBeginsBehind) ? 1u : 0u);
  const WalkStart start = WalkStart(ray.t_begin, from.cell, behind_count);
  if (ray.t_begin >= ray.t_end) return walkBeside(start);
  return walkRay(scene, kMeetsReflections, ray, start, reflected.inv_z_tolerance,
                 reflected.eye_z);
}

Found foundBy(Scene scene, Pinhole pinhole, Spot from, Ray ray, Walk walked) {
  Walk walk = walked;
  const uint body = meetBody(scene, pinhole, ray, walk);
  const Light light = opaqueLight(scene, ray, walk);
  const bool ends_behind = !walk.is_hit && walk.ends_behind && light.is_known;
  const float end_t = ends_behind ? farSideEnd(scene, ray, walk) : walk.t;
  const bool is_free = body == kBodyPassed && walk.is_hit && !walk.is_back;
  const bool is_unseen = (walk.is_assumed || walk.is_back || ends_behind) && !is_free;
  Found found;
  found.meets_surface = walk.is_hit && !walk.is_back;
  found.ending = walk.is_back                      ? kReflectionBack
                 : walk.is_assumed || ends_behind ? kReflectionAssumed
                 : walk.is_hit                    ? kReflectionHit
                                                  : kReflectionEnvironment;
  found.certainty = is_unseen ? certainty(pinhole, from, ray, walk.passed_t, end_t)
                              : float(walk.is_hit);
  found.certainty = light.is_known ? found.certainty : 0.0;
  const vec3 met_light = linearOfBlend(light.color.rgb, scene.color.format);
  found.light = mix(settings.environment, met_light, found.certainty);
  const vec3 point = ray.start + end_t * ray.extent;
  found.spot = Spot(point, walk.cell, walk.layer);
  return found;
}

#endif  // VIEWLOOM_LIB_MIRRORS_MIRRORED_WALK_GLSL_
