// SPDX-License-Identifier: Apache-2.0
// Answer of several sources together to a ray, from the oracle's answer for each, in metric space
// and double precision: shaders/walk.md, Several sources.
#pragma once

#include <functional>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "oracle/cube_map.h"
#include "oracle/plane_error.h"

namespace viewloom::oracle {

// A pinhole, or a cube map.
struct PosedSource {
  const OracleSource* source = nullptr;
  ConnectionTolerance kappa;
  const OracleCube* cube = nullptr;            // in place of both
  glm::dvec3 position_m{0.0};                  // in the world
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  // w, x, y, z: source to world
};

// The same ray as the source sees it.
ViewRay seenFrom(const PosedSource& source, const ViewRay& ray_world);

// Answer of one source. Places along the ray are 1/Z of the view, whose ray's direction is one
// metre along its axis long.
struct SourceAnswer {
  RayClass ray_class = RayClass::kOutside;
  double view_inv_z = 0;
  double tolerance = 0;
  double entry_inv_z = -1;  // from there on the source has seen what is free; -1 = never
  double weight = 0;
};

// Answer of a source to a ray, and its weight.
struct TracedSource {
  RayClass ray_class = RayClass::kOutside;
  double entry_inv_z = -1;
  // For a hit: the pinhole that answers, the source itself or a face of it, and the ray in its
  // space.
  SeenFacets facets;
  ViewRay seen;
  OracleHit hit;
};

// `move`: of what a face of a cube map sees, or the source that is none.
TracedSource traceSource(const PosedSource& source, const ViewRay& ray_world,
                         const FaceMove& move = {});
SourceAnswer sourceAnswer(const TracedSource& traced);

struct MergedAnswer {
  RayClass ray_class = RayClass::kOutside;
  double view_inv_z = 0;
  std::vector<double> shares;  // of each source in the colour of a hit; their sum is 1
};

// `slack`: times every tolerance; 1 is the definition.
MergedAnswer mergeAnswers(const std::vector<SourceAnswer>& answers, double slack = 1);

}  // namespace viewloom::oracle
