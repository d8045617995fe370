// SPDX-License-Identifier: Apache-2.0
#include "oracle/mirrored_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace viewloom::oracle {
namespace {

// Positions on a surface are rounded to so many parts of a px before its neighbours are blended.
constexpr double kPartsOfPx = 256;

// Camera space has y upwards and looks along -z; images have y downwards and Z forward.
glm::dvec3 flipped(const glm::dvec3& v) {
  return {v.x, -v.y, -v.z};
}

// Line of sight of a point of the image, for a Z of 1 m.
glm::dvec3 lineOfSight(const Pinhole& pinhole, double x_px, double y_px) {
  const glm::dvec2 at = (glm::dvec2(x_px, y_px) - pinhole.principal_px) / pinhole.focal_px;
  return flipped({at.x, at.y, 1.0});
}

// Normal of the plane of a facet through a place: (a x + b y + c) Z = 1, towards the camera.
glm::dvec3 normalOf(const OracleSource& source, const FacetAt& at, double x_px, double y_px,
                    double inv_z) {
  const Facet& facet = source.facet(at);
  const auto& [focal_px, principal_px] = source.pinhole();
  const glm::dvec2 slope(facet.slope_x, facet.slope_y);
  const double at_axis = inv_z + glm::dot(slope, principal_px - glm::dvec2(x_px, y_px));
  return -glm::normalize(flipped({slope.x * focal_px.x, slope.y * focal_px.y, at_axis}));
}

// Facet to which a facet is linked in a column beside it; layer -1: nothing.
FacetAt linkedIn(const OracleSource& source, const FacetAt& from, int step_x, int step_y) {
  const int column = from.column + step_x, row = from.row + step_y;
  const bool is_inside =
      column >= 0 && row >= 0 && column < source.width() && row < source.height();
  for (int layer = 0; from.layer >= 0 && is_inside && layer < source.layerCount(); ++layer) {
    if (source.linked(from, {layer, column, row})) return {layer, column, row};
  }
  return {};
}

bool isDeep(const OracleSource& source, const FacetAt& far, int step_x, int step_y) {
  const FacetAt near{far.layer, far.column + step_x, far.row + step_y};
  const bool is_inside = near.column >= 0 && near.row >= 0 && near.column < source.width() &&
                         near.row < source.height();
  return is_inside && source.exists(near) && source.deepBehind(far, near);
}

// The neighbour along an axis that takes part, and its share.
struct Neighbour {
  int toward = 1;
  double share = 0;
};

// Beside a deep silhouette, the one further in is blended with: never that across it.
Neighbour neighbourAlong(const OracleSource& source, const FacetAt& own, int axis, double offset) {
  const auto linked = [&](int toward) {
    return linkedIn(source, own, axis == 0 ? toward : 0, axis == 0 ? 0 : toward).layer >= 0;
  };
  const auto deep = [&](int toward) {
    return isDeep(source, own, axis == 0 ? toward : 0, axis == 0 ? 0 : toward);
  };
  int toward = offset >= 0 ? 1 : -1;
  if (deep(-1) != deep(1) && linked(deep(-1) ? 1 : -1)) toward = deep(-1) ? 1 : -1;
  return {toward, std::clamp(offset * toward, 0.0, 1.0)};
}

// Bilinear between the normals of the facets around a place that are linked to its own. What is
// infinitely far has none: beside that, the own facet's counts alone.
glm::dvec3 blendedNormal(const OracleSource& source, const MirrorSpot& spot) {
  const FacetAt& own = spot.facet;
  const auto offsetOf = [](double at_px, int cell) {
    return std::round((at_px - cell - 0.5) * kPartsOfPx) / kPartsOfPx;
  };
  const Neighbour x = neighbourAlong(source, own, 0, offsetOf(spot.x_px, own.column));
  const Neighbour y = neighbourAlong(source, own, 1, offsetOf(spot.y_px, own.row));
  const FacetAt beside = linkedIn(source, own, x.toward, 0);
  const FacetAt below = linkedIn(source, own, 0, y.toward);
  const FacetAt across = beside.layer >= 0 ? linkedIn(source, beside, 0, y.toward)
                                           : linkedIn(source, below, x.toward, 0);
  glm::dvec3 sum(0.0);
  const auto add = [&](const FacetAt& at, double weight) {
    if (at.layer < 0) return;
    sum += weight *
           normalOf(source, at, at.column + 0.5, at.row + 0.5, double{source.facet(at).inv_z});
  };
  add(own, (1 - x.share) * (1 - y.share));
  add(beside, x.share * (1 - y.share));
  add(below, (1 - x.share) * y.share);
  add(across, x.share * y.share);
  const bool has_normal = glm::dot(sum, sum) > 0;  // not so where a term is not a number
  return has_normal ? glm::normalize(sum) : normalOf(source, own, spot.x_px, spot.y_px, spot.inv_z);
}

// By how much what is one with the surface may stand out from it, 1/m.
double surfaceError(const OracleSource& source, const MirrorSpot& spot, const glm::dvec3& eye_m,
                    const MirrorTolerance& tolerance) {
  const double cross =
      glm::length(glm::cross(lineOfSight(source.pinhole(), spot.x_px, spot.y_px), eye_m));
  const double kappa = source.kappa().at(spot.inv_z);
  const double seen = cross > 0 ? std::min(tolerance.moved_rad / cross, 0.5 * kappa) : 0.5 * kappa;
  return seen + tolerance.measured + tolerance.rounding;
}

}  // namespace

MirrorSpot mirrorSpotAt(const OracleSource& source, double x_px, double y_px, double inv_z) {
  const int column = std::clamp(int(x_px), 0, source.width() - 1);
  const int row = std::clamp(int(y_px), 0, source.height() - 1);
  MirrorSpot nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int layer = 0; layer < source.layerCount(); ++layer) {
    const FacetAt at{layer, column, row};
    if (!source.exists(at)) continue;
    // No facet is below 0.
    const double own = std::max(source.planeInvZ(at, x_px, y_px), 0.0);
    if (std::abs(own - inv_z) >= least) continue;
    least = std::abs(own - inv_z);
    nearest = {at, x_px, y_px, own};
  }
  return nearest;
}

MirroredRay mirrored(const OracleSource& source, const MirrorSpot& spot, const glm::dvec3& eye_m,
                     const MirrorTolerance& tolerance) {
  const glm::dvec3 sight = lineOfSight(source.pinhole(), spot.x_px, spot.y_px);
  const glm::dvec3 to_spot = sight / spot.inv_z - eye_m;
  const glm::dvec3 own = normalOf(source, spot.facet, spot.x_px, spot.y_px, spot.inv_z);
  const glm::dvec3 normal = blendedNormal(source, spot);
  const glm::dvec3 goes = glm::reflect(glm::normalize(to_spot), normal);
  const double above = glm::dot(goes, own);
  const glm::dvec3 eye_behind_m = eye_m + 2 * glm::dot(to_spot, normal) * normal;
  const double error = surfaceError(source, spot, eye_behind_m, tolerance);
  return {.ray = {.origin_m = sight / (spot.inv_z + error),
                  .direction = glm::normalize(goes + std::max(-above, 0.0) * own)},
          .is_bent = above <= 0};
}

}  // namespace viewloom::oracle
