// SPDX-License-Identifier: Apache-2.0
// Surfaces of the synthetic scene at the point that a ray met: textures, sun and haze, the same
// from every side; their gloss; their motion.
#pragma once

#include <array>
#include <cstdint>

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

// A finish in numbers.
struct Gloss {
  glm::vec3 light{0.0F};  // mirrored head on, linear
  float roughness = 0;    // the square root of the width of GGX
  float own_share = 1;    // that is left of its own colour
};

Gloss glossOf(const Scene& scene, const Hit& hit);

// PLANE_ENCODING_OCT16 of a vector of any length but 0, u in the low half.
uint32_t octahedron(const glm::vec3& normal);

// m/s in the world. Balls, rods and the panel move; the rest stands.
glm::dvec3 surfaceMotion(const Scene& scene, const Hit& hit, const glm::dvec3& point_m);

// Bits of binary16.
std::array<uint16_t, 3> halvesOf(const glm::dvec3& vector);

}  // namespace viewloom::synthetic
