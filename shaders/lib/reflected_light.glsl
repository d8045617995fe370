// SPDX-License-Identifier: Apache-2.0
// What surfaces mirror, as px keep it.
#ifndef VIEWLOOM_LIB_REFLECTED_LIGHT_GLSL_
#define VIEWLOOM_LIB_REFLECTED_LIGHT_GLSL_

#include "shared/reflection_abi.h"

const ReflectedLight kNothingReflected = ReflectedLight(uvec2(0u), 0u, 0u);
// What binary16 holds: light, and how far what is mirrored lies behind the surface, m.
const float kHalfMax = 65504.0;

// How much a surface beyond another counts: the longer a ray went on unseen, the likelier it has
// met what nobody knows of. `inv_z`: of the mirror.
float certaintyOf(float unseen_m, float inv_z) {
  return exp(-unseen_m * inv_z);
}

// An octahedron's corners folded onto its middle, or back: the half of normals that look away from
// the camera, along which z goes.
vec2 foldedOctahedron(vec2 across) {
  return (1.0 - abs(across.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(across, vec2(0.0)));
}

// The place of a mirror, by which px know their like.
uint packedPlace(vec3 normal, float inv_z) {
  const vec3 on = normal / (abs(normal.x) + abs(normal.y) + abs(normal.z));
  const vec2 across = on.z > 0.0 ? foldedOctahedron(on.xy) : on.xy;
  return (packSnorm4x8(vec4(across, 0.0, 0.0)) & 0xffffu) |
         (floatBitsToUint(inv_z) & 0xffff0000u);
}

vec3 reflectanceOf(ReflectedLight light) {
  const vec3 root = unpackUnorm4x8(light.reflectance).rgb;
  return root * root;
}

vec3 normalOfPlace(uint place) {
  const vec2 across = unpackSnorm4x8(place & 0xffffu).xy;
  const float z = abs(across.x) + abs(across.y) - 1.0;
  return normalize(vec3(z > 0.0 ? foldedOctahedron(across) : across, z));
}

// What rays find together that the surface takes less than this share of what it mirrors from says
// little of what it mirrors: they go along it.
const float kTellingShare = 0.05;

float largestOf(vec3 light) {
  return max(light.r, max(light.g, light.b));
}

// What is mirrored, by the light that rays found, weighted by what the surface takes of each of
// them, and by these weights; before it takes its `reflectance` of it.
ReflectedLight packedLight(vec3 light_sum, vec3 share_sum, uint count, vec3 reflectance,
                           float distance_m, float roughness, uint place) {
  const vec3 bounded = min(light_sum / max(share_sum, vec3(1e-6)), vec3(kHalfMax));
  const bool tells =
      largestOf(share_sum) >= kTellingShare * float(count) * largestOf(reflectance);
  return ReflectedLight(
      uvec2(packHalf2x16(bounded.rg), packHalf2x16(vec2(bounded.b, distance_m))),
      packUnorm4x8(vec4(sqrt(reflectance), roughness)), tells ? place : place | kTellsLittle);
}

#endif  // VIEWLOOM_LIB_REFLECTED_LIGHT_GLSL_
