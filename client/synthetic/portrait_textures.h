// SPDX-License-Identifier: Apache-2.0
// Textures of the portrait scene: a painted sky, a paved ground, and a board with letters and
// lines by which a viewer judges sharpness.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "synthetic/scene.h"

namespace viewloom::synthetic {

// Linear light of the sky painted at a point of a wall of the backdrop.
glm::vec3 paintedSky(const Scene& scene, const glm::dvec3& point_m);

// The ridge that goes on as paint at this point of a side wall, and where on it: x grows along the
// wall. No ridge where the sky is painted.
struct PaintedRidge {
  const Ridge* ridge = nullptr;
  glm::dvec2 xy_m{0.0};
};
PaintedRidge paintedRidge(const Scene& scene, const glm::dvec3& point_m);

// edge_m: half width over which edges blend, metres on the surface.
glm::vec3 pavedGroundTexture(glm::vec2 xz, float edge_m);

// uv_m: metres from the board's middle, to the right and up.
glm::vec3 boardTexture(glm::vec2 uv_m, glm::vec2 half_size_m, float edge_m);

}  // namespace viewloom::synthetic
