// SPDX-License-Identifier: Apache-2.0
// What a surface of the synthetic scene looks like: textures, sun, haze; the same from every
// side.
#pragma once

#include <glm/vec3.hpp>

#include "synthetic/cast_row.h"
#include "synthetic/sun_shadows.h"

namespace viewloom::synthetic {

// Linear light, 0..1. `direction` is the ray's, of any length; it matters for the sky alone.
// edge_m: half width over which texture edges blend, metres on the surface.
glm::vec3 surfaceColor(const Scene& scene, const SunShadows& shadows, const Hit& hit,
                       const glm::dvec3& point_m, const glm::dvec3& direction, float edge_m);

// Where it faces in the world, towards who looks; unit length. Not for the sky.
glm::vec3 surfaceNormal(const Scene& scene, const Hit& hit, const glm::dvec3& point_m,
                        const glm::dvec3& direction);

}  // namespace viewloom::synthetic
