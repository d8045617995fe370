// SPDX-License-Identifier: Apache-2.0
// How the surfaces of the synthetic scene move: the balls and the panel; the rest stands.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

#include "synthetic/cast_row.h"

namespace viewloom::synthetic {

// Of what a ray met at a point, m/s in the world.
glm::dvec3 surfaceMotion(const Scene& scene, const Hit& hit, const glm::dvec3& point_m);

// As binary16.
std::array<uint16_t, 3> halvesOf(const glm::dvec3& vector);

}  // namespace viewloom::synthetic
