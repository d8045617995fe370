// SPDX-License-Identifier: Apache-2.0
// Reflected light of surfaces, as pixels keep it.
#ifndef VIEWLOOM_LIB_MIRRORS_REFLECTED_LIGHT_GLSL_
#define VIEWLOOM_LIB_MIRRORS_REFLECTED_LIGHT_GLSL_

#include "shared/reflection_abi.h"

const ReflectedLight kNothingReflected = ReflectedLight(uvec2(0u), 0u, 0u);
// Limit of binary16 for light, and for the distance of mirrored things behind the surface, m.
const float kHalfMax = 65504.0;

// 1/m: how close to the surface a ray found something.
float closenessOf(float way_m) {
  return 1.0 / clamp(way_m, 1.0 / kHalfMax, kHalfMax);
}

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

// Packed as square roots, with the roughness.
uint packedReflectance(vec3 reflectance, float roughness) {
  return packUnorm4x8(vec4(sqrt(reflectance), roughness));
}

vec3 reflectanceOf(uint packed) {
  const vec3 root = unpackUnorm4x8(packed).rgb;
  return root * root;
}

float roughnessOf(uint packed) {
  return unpackUnorm4x8(packed).a;
}

// The exponent of a binary16 and three bits of its fraction: within a sixteenth.
uint packedDistance(float distance_m) {
  return min(packHalf2x16(vec2(distance_m, 0.0)) + 0x40u, 0x7bffu) >> 7;
}

float unpackedDistance(uint packed) {
  return unpackHalf2x16(packed << 7).x;
}

// Limit of weights for the light that a pixel's rays found: 1 in the mean, kept as square roots.
const float kWeightMax = 64.0;

uint packedWeight(float weight) {
  return uint(255.0 * sqrt(clamp(weight / kWeightMax, 0.0, 1.0)) + 0.5);
}

float unpackedWeight(uint packed) {
  const float root = float(packed) / 255.0;
  return kWeightMax * root * root;
}

vec3 normalOfPlace(uint place) {
  const vec2 across = unpackSnorm4x8(place & 0xffffu).xy;
  const float z = abs(across.x) + abs(across.y) - 1.0;
  return normalize(vec3(z > 0.0 ? foldedOctahedron(across) : across, z));
}

float largestOf(vec3 light) {
  return max(light.r, max(light.g, light.b));
}

// Reflected light: the light that rays found, weighted by the surface's share of each ray, divided
// by these weights. The packed `reflectance` of the surface is not yet applied.
ReflectedLight packedLight(vec3 light_sum, vec3 share_sum, uint count, uint reflectance,
                           float closeness, uint place) {
  const vec3 bounded = min(light_sum / max(share_sum, vec3(1e-12)), vec3(kHalfMax));
  const float taken = largestOf(reflectanceOf(reflectance)) * float(count);
  const uint beside = packedDistance(1.0 / max(closeness, 1.0 / kHalfMax)) |
                      packedWeight(largestOf(share_sum) / max(taken, 1e-12)) << 8;
  return ReflectedLight(
      uvec2(packHalf2x16(bounded.rg), packHalf2x16(vec2(bounded.b, 0.0)) | beside << 16),
      reflectance, place);
}

#endif  // VIEWLOOM_LIB_MIRRORS_REFLECTED_LIGHT_GLSL_
