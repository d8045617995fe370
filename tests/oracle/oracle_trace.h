// SPDX-License-Identifier: Apache-2.0
// What a ray answers, found column by column in metric space and double precision, without a
// hierarchy.
#pragma once

#include <iosfwd>
#include <vector>

#include <glm/vec3.hpp>

#include "oracle/oracle_source.h"

namespace viewloom::oracle {

// A half line in the source's camera space (metres, +y up, -z forward). Any length of direction.
struct Ray {
  glm::dvec3 origin_m{0.0};
  glm::dvec3 direction{0.0, 0.0, -1.0};
};

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
  bool assumed = false;
  FacetAt facet;
  // The facet on this side of the edge when a connected surface was crossed at an edge: an answer
  // may name either. layer -1 otherwise.
  FacetAt linked_facet;
};

struct OracleAnswer {
  std::vector<OracleHit> hits;              // along the ray, at most as many as asked for
  RayClass ray_class = RayClass::kOutside;  // of the first hit, or how the ray ended without one
};

// A ray seen by a source, in homogeneous form: its points are a + s (b - a), s in [0, 1]; the image
// position is (u, v) / z in px and 1/Z is h / z. Every facet, column border and limit is a plane
// through these four, so each crossing is one division, also at infinity (h = 0).
struct HomogeneousPoint {
  double u = 0, v = 0, z = 0, h = 0;
};
struct ProjectedRay {
  HomogeneousPoint a, b;

  HomogeneousPoint at(double s) const;
};

ProjectedRay projectRay(const Pinhole& pinhole, const Ray& ray);
// The same ray seen elsewhere: every point moved in the image and in 1/Z.
ProjectedRay movedBy(const ProjectedRay& ray, double x_px, double y_px, double inv_z);

// The part of a ray that the source sees: inside the image, in front of the camera, 1/Z >= 0.
struct SeenPart {
  double begin = 0;
  double end = 0;
  bool ends_at_infinity = false;
  bool empty() const { return !(begin < end); }
};
SeenPart seenPart(const OracleSource& source, const ProjectedRay& ray);

// How far a point stands in front of a facet's plane, scaled by Z: h - (a u + b v + c z).
double inFront(const OracleSource& source, const FacetAt& at, const HomogeneousPoint& point);

// All events up to hit_limit: beyond the first, the ray goes on behind what it hit, and a later hit
// is assumed only where it passed behind something it did not hit.
OracleAnswer traceOracle(const OracleSource& source, const ProjectedRay& ray, size_t hit_limit = 1);
OracleAnswer traceOracle(const OracleSource& source, const Ray& ray, size_t hit_limit = 1);

}  // namespace viewloom::oracle
