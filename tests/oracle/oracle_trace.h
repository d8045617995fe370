// SPDX-License-Identifier: Apache-2.0
// Answer of a ray, found column by column in metric space and double precision, without a
// hierarchy.
#pragma once

#include <iosfwd>
#include <vector>

#include "oracle/projected_ray.h"

namespace viewloom::oracle {

enum class RayClass { kHit, kHitAssumed, kHidden, kOutside, kEmpty };

inline bool isHit(RayClass ray_class) {
  return ray_class == RayClass::kHit || ray_class == RayClass::kHitAssumed;
}

const char* nameOf(RayClass ray_class);
std::ostream& operator<<(std::ostream& out, RayClass ray_class);

struct OracleHit {
  double x_px = 0;
  double y_px = 0;
  double inv_z = 0;  // 1/m
  double s = 0;      // along the projected ray
  bool assumed = false;
  bool is_back = false;  // it came out through the surface, from behind
  FacetAt facet;
  // The facet on this side of the edge when a connected surface was crossed at an edge: an answer
  // may name either. layer -1 otherwise.
  FacetAt linked_facet;
};

struct OracleAnswer {
  std::vector<OracleHit> hits;              // along the ray, at most as many as asked for
  RayClass ray_class = RayClass::kOutside;  // of the first hit, or how the ray ended without one
  // Where it first was behind known surface, before any hit; beyond 1: nowhere.
  double passed_s = 2;
};

// All events up to hit_limit: beyond the first, the ray goes on behind what it hit, and a later hit
// is assumed only where it passed behind something it did not hit.
OracleAnswer traceOracle(const OracleSource& source, const ProjectedRay& ray, size_t hit_limit = 1);
OracleAnswer traceOracle(const OracleSource& source, const Ray& ray, size_t hit_limit = 1);
// Answer of a part of it alone, inside the image and not empty.
OracleAnswer traceOracle(const OracleSource& source, const ProjectedRay& ray, const SeenPart& part,
                         size_t hit_limit = 1);

// Answer of a ray that goes on from the front of a surface, as off a mirror: behind the layers
// before that one, in front of it and of those behind. A ray that comes out through a surface from
// behind it has met an unseen part, and ends there.
OracleAnswer traceFromSurface(const OracleSource& source, const ProjectedRay& ray,
                              int surface_layer);

}  // namespace viewloom::oracle
