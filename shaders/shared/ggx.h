// SPDX-License-Identifier: Apache-2.0
// Microfacets of GGX with heights that are correlated (Heitz, Understanding the Masking-Shadowing
// Function in Microfacet-Based BRDFs, JCGT 2014), in the space of the surface: z is its normal.
// `alpha`: width, the square of roughness.
#ifndef VIEWLOOM_SHADERS_SHARED_GGX_H_
#define VIEWLOOM_SHADERS_SHARED_GGX_H_

#include "shared/gpu_types.h"

#ifdef __cplusplus
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#endif

VIEWLOOM_ABI_BEGIN

#ifdef __cplusplus
using glm::clamp;
using glm::cos;
using glm::max;
using glm::normalize;
using glm::sin;
using glm::sqrt;
#endif

// The normal of one of the microfacets that `towards` (unit length, to who looks) sees: a place on
// the cap of a sphere (Dupuy and Benyoub, Sampling Visible GGX Normals with Spherical Caps, 2023).
// `place`: 0..1 each.
VIEWLOOM_ABI_INLINE vec3 visibleNormal(vec3 towards, float alpha, vec2 place) {
  const vec3 stretched = normalize(vec3(alpha * towards.x, alpha * towards.y, towards.z));
  const float angle = 6.28318531f * place.x;
  const float z = (1.0f - place.y) * (1.0f + stretched.z) - stretched.z;
  const float across = sqrt(clamp(1.0f - z * z, 0.0f, 1.0f));
  const vec3 halfway = vec3(across * cos(angle), across * sin(angle), z) + stretched;
  return normalize(vec3(alpha * halfway.x, alpha * halfway.y, max(halfway.z, 1e-6f)));
}

// Smith's, of the cosine to the normal.
VIEWLOOM_ABI_INLINE float shadowing(float cosine, float alpha) {
  const float cosine2 = cosine * cosine;
  const float tangent2 = (1.0f - cosine2) / max(cosine2, 1e-12f);
  return 0.5f * (sqrt(1.0f + alpha * alpha * tangent2) - 1.0f);
}

// Share of the light from a direction that a visible microfacet passes on, beside its Fresnel: the
// light that others do not hide, divided by their visible share (G2 / G1).
VIEWLOOM_ABI_INLINE float unshadowed(float cosine_in, float cosine_out, float alpha) {
  const float seen = 1.0f + shadowing(cosine_out, alpha);
  return seen / (seen + shadowing(cosine_in, alpha));
}

// Schlick's: how much of what is mirrored along a surface more than head on counts. `cosine` of the
// angle to the microfacet's normal.
VIEWLOOM_ABI_INLINE float fresnelRest(float cosine) {
  const float rest = 1.0f - clamp(cosine, 0.0f, 1.0f);
  const float rest2 = rest * rest;
  return rest2 * rest2 * rest;
}

// The albedo of a rough surface, as it is seen from one direction, is a F0 + b (F90 - F0) (Karis,
// Real Shading in Unreal Engine 4, 2013). A table of a and b, 16 bits each: the one with index
// r n + c, n = kAlbedoSteps, is of roughness r / (n - 1), seen at a cosine of (c / (n - 1))^2 to
// the normal.
VIEWLOOM_ABI_CONST uint kAlbedoSteps = 32u;

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_GGX_H_
