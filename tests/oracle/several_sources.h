// SPDX-License-Identifier: Apache-2.0
// What a ray is answered by several sources together, from what the oracle says of each, in metric
// space and double precision: shaders/README.md, Several sources.
#pragma once

#include <functional>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "oracle/oracle_trace.h"
#include "oracle/view_generator.h"

namespace viewloom::oracle {

struct PosedSource {
  const OracleSource* source = nullptr;
  ConnectionTolerance kappa;
  glm::dvec3 position_m{0.0};                  // in the world
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // w, x, y, z: source to world
};

// The same ray as the source sees it.
ViewRay seenFrom(const PosedSource& source, const ViewRay& ray_world);

// Of one source. Places along the ray are 1/Z of the view, whose ray's direction is one metre along
// its axis long.
struct SourceAnswer {
  RayClass ray_class = RayClass::kOutside;
  double view_inv_z = 0;
  double tolerance = 0;
  double entry_inv_z = -1;  // from there on the source has seen what is free; -1 = never
  double weight = 0;
};

// `answer`: of the source to `projected`, which is the ray, or one moved a little.
SourceAnswer sourceAnswer(const PosedSource& source, const ViewRay& ray,
                          const ProjectedRay& projected, const OracleAnswer& answer);

struct MergedAnswer {
  RayClass ray_class = RayClass::kOutside;
  double view_inv_z = 0;
  std::vector<double> shares;  // of each source in the colour of a hit; their sum is 1
};

// `slack`: times every tolerance; 1 is the definition.
MergedAnswer mergeAnswers(const std::vector<SourceAnswer>& answers, double slack = 1);

}  // namespace viewloom::oracle
