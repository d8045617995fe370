// SPDX-License-Identifier: Apache-2.0
// How much of all the light around it a surface mirrors.
#ifndef VIEWLOOM_LIB_MIRRORS_ALBEDO_GLSL_
#define VIEWLOOM_LIB_MIRRORS_ALBEDO_GLSL_

#include "lib/mirrors/ggx.glsl"
#include "lib/mirrors/mirror.glsl"
#include "shared/reflection_abi.h"

layout(set = 0, binding = kBindingAlbedos, scalar) readonly buffer Albedos {
  uint albedos[];
};

vec2 albedoTexel(uvec2 at) {
  return unpackUnorm2x16(albedos[at.y * kAlbedoSteps + at.x]);
}

// Albedo of a rough mirror, seen at a cosine to its normal.
vec3 albedoOf(Mirror mirror, float cosine) {
  const vec2 at =
      clamp(vec2(sqrt(max(cosine, 0.0)), mirror.roughness), 0.0, 1.0) * float(kAlbedoSteps - 1u);
  const uvec2 low = min(uvec2(at), kAlbedoSteps - 2u);
  const vec2 share = at - vec2(low);
  const vec2 less_rough = mix(albedoTexel(low), albedoTexel(low + uvec2(1u, 0u)), share.x);
  const vec2 rougher =
      mix(albedoTexel(low + uvec2(0u, 1u)), albedoTexel(low + uvec2(1u)), share.x);
  const vec2 parts = mix(less_rough, rougher, share.y);
  const vec3 head_on = mirror.light;
  return parts.x * head_on + parts.y * max(reflectanceAlong(head_on) - head_on, 0.0);
}

#endif  // VIEWLOOM_LIB_MIRRORS_ALBEDO_GLSL_
