// SPDX-License-Identifier: Apache-2.0
// A ray on its way from surface to surface: how each of them turns it, and what that says of how
// well it is known.
#ifndef VIEWLOOM_LIB_MIRRORS_MIRRORED_PATH_GLSL_
#define VIEWLOOM_LIB_MIRRORS_MIRRORED_PATH_GLSL_

#include "lib/mirrors/ggx.glsl"
#include "lib/mirrors/mirror.glsl"

// Surfaces up to this roughness are mirrors: they spread light by less than pixels show.
const float kMirrorRoughness = 0.02;
// Steps of the depth samples, and sigmas of their noise, by which a surface stands out from itself.
const float kStepsOfSurface = 1.0;
const float kSigmasOfSurface = 4.0;
// Surfaces seen along them are mirrors, too: no microfacet shows.
const float kCosineAlong = 1e-4;

struct Path {
  vec3 direction;  // unit length
  vec3 eye;        // where it seems to come from, behind all mirrors so far; m
  vec3 share;      // of the light that it finds
  bool is_bent;
};

// To who looks at it, as a cosine to its normal.
float cosineTowards(Mirror mirror, Path path) {
  return dot(-path.direction, mirror.normal);
}

bool isRough(Mirror mirror, float cosine) {
  return mirror.roughness > kMirrorRoughness && cosine > kCosineAlong;
}

// Off a mirror, by its own normal or by that of a microfacet. Who would go on below the surface
// itself goes along it.
void turn(Mirror mirror, Spot spot, Pinhole pinhole, vec2 place, inout Path path) {
  const float alpha = mirror.roughness * mirror.roughness;
  const mat3 basis = basisAround(mirror.normal);
  const vec3 towards = -path.direction * basis;
  const bool is_rough = isRough(mirror, towards.z);
  const vec3 halfway =
      is_rough ? basis * visibleNormal(towards, alpha, place) : mirror.normal;
  const vec3 facing = hasFault(kFaultNormalTurned) ? vec3(-1.0, 1.0, 1.0) : vec3(1.0);
  vec3 direction = reflect(path.direction, facing * halfway);
  const float above = dot(direction, mirror.facet_normal);
  path.is_bent = path.is_bent || above <= 0.0;
  const float below = hasFault(kFaultNotBent) ? 0.0 : max(-above, 0.0);
  direction = normalize(direction + below * mirror.facet_normal);
  path.share *= fresnel(mirror.light, dot(direction, halfway));
  const float cosine_out = max(dot(direction, mirror.normal), kCosineAlong);
  if (is_rough) path.share *= unshadowed(cosine_out, max(towards.z, kCosineAlong), alpha);
  path.direction = direction;
  const vec3 to_eye = path.eye - metresOf(pinhole, spot.point);
  path.eye -= 2.0 * dot(to_eye, mirror.normal) * mirror.normal;
}

// By how much what is one with a surface may stand out from it. `moved_px`: as for reflectedRay().
float surfaceError(Scene scene, Pinhole pinhole, Spot spot, vec3 eye, float moved_px) {
  const float cross = length(cross(metricPoint(pinhole, vec3(spot.point.xy, 1.0)), eye));
  const float kappa = stepAt(scene.kappa, spot.point.z);
  const float seen = min(moved_px / max(cross, 1e-30), 0.5 * kappa);
  const float measured = max(kStepsOfSurface * measured_head.depth_step,
                             kSigmasOfSurface * measured_head.noise_sigma);
  return seen + measured + kRounding * scene.inv_z_near;
}

// Where a ray ends that ended behind surfaces: its far side goes on as far back as it was seen.
float farSideEnd(Scene scene, Ray ray, Walk walk) {
  const uvec2 far_facet = loadFacet(scene.layers, walk.far_layer, scene.extent, walk.far_cell);
  const float far_t = ray.extent.z < 0.0
                          ? (max(facetInvZ(far_facet), 0.0) - ray.start.z) / ray.extent.z
                          : ray.t_end;
  return clamp(far_t, min(walk.passed_t, ray.t_end), ray.t_end);
}

#endif  // VIEWLOOM_LIB_MIRRORS_MIRRORED_PATH_GLSL_
