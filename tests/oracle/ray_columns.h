// SPDX-License-Identifier: Apache-2.0
// The columns of a source that a ray passes through, one after the other.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "oracle/projected_ray.h"

namespace viewloom::oracle {

// Where a ray leaves one column for the next.
struct Crossing {
  double s = 0;
  int step_x = 0;
  int step_y = 0;
};

struct Column {
  int column = 0;
  int row = 0;
};

// Where a point stands in the image, px.
glm::dvec2 imageOf(const HomogeneousPoint& point);

// The column of a point, or the one nearest to it.
Column columnAt(const OracleSource& source, const HomogeneousPoint& point);

// All of the part that the source sees, along the ray.
std::vector<Crossing> crossingsOf(const OracleSource& source, const ProjectedRay& ray,
                                  const SeenPart& seen);

}  // namespace viewloom::oracle
