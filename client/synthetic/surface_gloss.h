// SPDX-License-Identifier: Apache-2.0
// What the surfaces of the synthetic scene mirror, where it has mirrors: the ground is a lake, some
// balls and the panel are of metal.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "synthetic/cast_row.h"

namespace viewloom::synthetic {

struct Gloss {
  glm::vec3 light{0.0F};  // mirrored head on, linear
  float roughness = 0;    // the square root of the width of GGX
  float own_share = 1;    // that is left of its own colour
};

Gloss glossOf(const Hit& hit);

// PLANE_ENCODING_OCT16 of a vector of any length but 0, u in the low half.
uint32_t octahedron(const glm::vec3& normal);

}  // namespace viewloom::synthetic
