// SPDX-License-Identifier: Apache-2.0
#include "oracle/plane_error.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace viewloom::oracle {
namespace {

bool isInImage(const OracleSource& source, const glm::dvec3& sight) {
  const Pinhole& pinhole = source.pinhole();
  const double x_px = pinhole.principal_px.x + pinhole.focal_px.x * sight.x;
  const double y_px = pinhole.principal_px.y - pinhole.focal_px.y * sight.y;
  return std::min(x_px, y_px) >= 0 && x_px <= source.width() && y_px <= source.height();
}

}  // namespace

// Seen from b, a point r / w stands beside itself by |r x b| dw / |r - w b|^2 radian when w is off
// by dw.
double planeErrorAt(const SeenFacets& facets, const ViewRay& seen,
                    const std::vector<double>& view_inv_zs, double output_px) {
  const double px =
      std::max(glm::length(seen.direction_per_px_x), glm::length(seen.direction_per_px_y)) /
      glm::length(seen.ray.direction);
  double error = 0;
  for (const double view_inv_z : view_inv_zs) {
    const glm::dvec3 from_pinhole = view_inv_z * seen.ray.origin_m + seen.ray.direction;
    const double depth = -from_pinhole.z;
    if (!std::isfinite(depth) || depth <= 0) continue;
    const glm::dvec3 sight = from_pinhole / depth;
    if (!isInImage(*facets.source, sight)) continue;
    const double inv_z = view_inv_z / depth;
    const glm::dvec3 from_eye = sight - inv_z * seen.ray.origin_m;
    const double turn =
        glm::length(glm::cross(sight, seen.ray.origin_m)) / glm::dot(from_eye, from_eye);
    const double half_kappa = 0.5 * facets.kappa.at(inv_z);
    error = std::max(error, turn > 0 ? std::min(half_kappa, output_px * px / turn) : half_kappa);
  }
  return error;
}

}  // namespace viewloom::oracle
