// SPDX-License-Identifier: Apache-2.0
#include "oracle/projected_ray.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace viewloom::oracle {

HomogeneousPoint ProjectedRay::at(double s) const {
  const auto between = [s](double from, double to) { return (1 - s) * from + s * to; };
  return {between(a.u, b.u), between(a.v, b.v), between(a.z, b.z), between(a.h, b.h)};
}

ProjectedRay projectRay(const Pinhole& pinhole, const Ray& ray) {
  const auto project = [&](const glm::dvec3& p, double h) {
    const double z = -p.z;
    return HomogeneousPoint{pinhole.focal_px.x * p.x + pinhole.principal_px.x * z,
                            -pinhole.focal_px.y * p.y + pinhole.principal_px.y * z, z, h};
  };
  return {project(ray.origin_m, 1), project(glm::normalize(ray.direction), 0)};
}

ProjectedRay movedBy(const ProjectedRay& ray, double x_px, double y_px, double inv_z) {
  const auto move = [&](const HomogeneousPoint& p) {
    return HomogeneousPoint{p.u + x_px * p.z, p.v + y_px * p.z, p.z, p.h + inv_z * p.z};
  };
  return {move(ray.a), move(ray.b)};
}

SeenPart seenPart(const OracleSource& source, const ProjectedRay& ray) {
  const auto& [a, b] = ray;
  SeenPart seen{0, 1, true};
  const auto keepNonNegative = [&seen](double at_a, double at_b, bool is_infinity) {
    if (at_a < 0 && at_b < 0) seen.end = -1;
    if (at_a < 0 && at_b >= 0) seen.begin = std::max(seen.begin, at_a / (at_a - at_b));
    if (at_a >= 0 && at_b < 0) {
      const double s = at_a / (at_a - at_b);
      if (s < seen.end) seen.ends_at_infinity = is_infinity;
      seen.end = std::min(seen.end, s);
    }
  };
  keepNonNegative(a.h, b.h, true);
  keepNonNegative(a.u, b.u, false);
  keepNonNegative(a.v, b.v, false);
  keepNonNegative(source.width() * a.z - a.u, source.width() * b.z - b.u, false);
  keepNonNegative(source.height() * a.z - a.v, source.height() * b.z - b.v, false);
  return seen;
}

double inFront(const OracleSource& source, const FacetAt& at, const HomogeneousPoint& point) {
  const Facet& f = source.facet(at);
  return point.h -
         (double(f.inv_z) * point.z + double(f.slope_x) * (point.u - (at.column + 0.5) * point.z) +
          double(f.slope_y) * (point.v - (at.row + 0.5) * point.z));
}

}  // namespace viewloom::oracle
