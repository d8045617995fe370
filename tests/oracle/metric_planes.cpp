// SPDX-License-Identifier: Apache-2.0
#include "oracle/metric_planes.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace viewloom::oracle {

Pyramid pyramidOver(const Pinhole& pinhole, double left, double top, double right, double bottom) {
  const auto ray = [&](double x, double y) {
    return glm::dvec3((x - pinhole.principal_px.x) / pinhole.focal_px.x,
                      -(y - pinhole.principal_px.y) / pinhole.focal_px.y, -1.0);
  };
  const glm::dvec3 corners[4] = {ray(left, top), ray(right, top), ray(right, bottom),
                                 ray(left, bottom)};
  const glm::dvec3 middle = ray(0.5 * (left + right), 0.5 * (top + bottom));
  Pyramid pyramid;
  for (int side = 0; side < 4; ++side) {
    glm::dvec3 normal = glm::cross(corners[side], corners[(side + 1) % 4]);
    if (glm::dot(normal, middle) < 0) normal = -normal;
    pyramid.sides[side] = {normal, 0};
  }
  return pyramid;
}

Stretch insideOf(const Pyramid& pyramid, const Ray& ray) {
  Stretch stretch;
  for (const HalfSpace& side : pyramid.sides) {
    const double at_origin = glm::dot(side.normal, ray.origin_m) + side.distance;
    const double per_step = glm::dot(side.normal, ray.direction);
    if (per_step == 0) {
      if (at_origin < 0) return {0, 0};
      continue;
    }
    const double crossing = -at_origin / per_step;
    if (per_step > 0) {
      stretch.begin = std::max(stretch.begin, crossing);
    } else {
      stretch.end = std::min(stretch.end, crossing);
    }
  }
  return stretch;
}

HalfSpace metricPlane(const OracleSource& source, const FacetAt& at) {
  const Facet& f = source.facet(at);
  const Pinhole& p = source.pinhole();
  const double at_principal = source.planeInvZ(at, p.principal_px.x, p.principal_px.y);
  // 1/Z = a x + b y + c times Z: 1 = a focal X - b focal Y + (a, b, c at the principal point) Z.
  return {{-double(f.slope_x) * p.focal_px.x, double(f.slope_y) * p.focal_px.y, at_principal}, 1};
}

double sideAt(const HalfSpace& plane, const Ray& ray, double distance) {
  if (distance == kInfinity) {
    const double slope = glm::dot(plane.normal, ray.direction);
    if (slope != 0) return slope;
    return glm::dot(plane.normal, ray.origin_m) + plane.distance;
  }
  return glm::dot(plane.normal, ray.origin_m + distance * ray.direction) + plane.distance;
}

}  // namespace viewloom::oracle
