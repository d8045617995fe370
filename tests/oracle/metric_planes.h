// SPDX-License-Identifier: Apache-2.0
// Rays against planes in metric space, for the oracle that asks every facet.
#pragma once

#include <limits>

#include <glm/vec3.hpp>

#include "oracle/projected_ray.h"

namespace viewloom::oracle {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A half space n . P + d >= 0 in metres.
struct HalfSpace {
  glm::dvec3 normal;
  double distance = 0;
};

// The pyramid over a rectangle of the image, as four half spaces through the camera.
struct Pyramid {
  HalfSpace sides[4];
};

Pyramid pyramidOver(const Pinhole& pinhole, double left, double top, double right, double bottom);

// Distances along the ray between which it is inside; empty when begin >= end.
struct Stretch {
  double begin = 0;
  double end = kInfinity;
  bool empty() const { return !(begin < end); }
};

Stretch insideOf(const Pyramid& pyramid, const Ray& ray);

// The metric plane of a facet, n . P + d, positive on the camera's side of it.
HalfSpace metricPlane(const OracleSource& source, const FacetAt& at);

// On which side of it a ray is at a distance, with its sign; also at infinity.
double sideAt(const HalfSpace& plane, const Ray& ray, double distance);

}  // namespace viewloom::oracle
