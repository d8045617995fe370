// SPDX-License-Identifier: Apache-2.0
// A ray as a source sees it: in its image, and in 1/Z.
#pragma once

#include <glm/vec3.hpp>

#include "oracle/oracle_source.h"

namespace viewloom::oracle {

// A half line in the source's camera space (metres, +y up, -z forward). Any length of direction.
struct Ray {
  glm::dvec3 origin_m{0.0};
  glm::dvec3 direction{0.0, 0.0, -1.0};
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

}  // namespace viewloom::oracle
