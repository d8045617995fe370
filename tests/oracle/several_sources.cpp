// SPDX-License-Identifier: Apache-2.0
#include "oracle/several_sources.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>

namespace viewloom::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Values of the definition.
constexpr double kAngleMin_rad = 1e-4;
constexpr double kDensityMin = 1e-6;
constexpr double kToleranceShareMax = 0.125;

// Px of the view by which a ray is moved to see how far its hit moves.
constexpr double kStep_px = 1e-3;

bool isHit(const SourceAnswer& answer) {
  return answer.ray_class == RayClass::kHit || answer.ray_class == RayClass::kHitAssumed;
}

// A line of sight of the source, one metre along its axis long.
glm::dvec3 lineOfSight(const Pinhole& pinhole, double x_px, double y_px) {
  return {(x_px - pinhole.principal_px.x) / pinhole.focal_px.x,
          -(y_px - pinhole.principal_px.y) / pinhole.focal_px.y, -1.0};
}

// Metres along the view's axis of a place in the source's image.
double depthInView(const OracleSource& source, const Ray& ray, double x_px, double y_px,
                   double inv_z) {
  if (inv_z <= 0) return kInfinity;
  const glm::dvec3 point = lineOfSight(source.pinhole(), x_px, y_px) / inv_z;
  return glm::dot(point - ray.origin_m, ray.direction) / glm::dot(ray.direction, ray.direction);
}

// Where a ray meets the plane that goes through a hit with the slopes of its facet, wherever that
// is, in px of the source. A hit at an edge may lie beside the facet's own plane.
std::optional<glm::dvec2> onPlane(const OracleSource& source, const OracleHit& hit,
                                  const Ray& ray) {
  const ProjectedRay projected = projectRay(source.pinhole(), ray);
  const double beside = hit.inv_z - source.planeInvZ(hit.facet, hit.x_px, hit.y_px);
  const double at_a = inFront(source, hit.facet, projected.a) - beside * projected.a.z;
  const double at_b = inFront(source, hit.facet, projected.b) - beside * projected.b.z;
  if (at_a == at_b) return {};
  const HomogeneousPoint point = projected.at(at_a / (at_a - at_b));
  return glm::dvec2(point.u / point.z, point.v / point.z);
}

// Px of the source per px of the view, in area.
double density(const OracleSource& source, const OracleHit& hit, const ViewRay& ray) {
  glm::dvec2 moved[2];
  for (int axis = 0; axis < 2; ++axis) {
    const glm::dvec2 step = axis == 0 ? glm::dvec2(kStep_px, 0) : glm::dvec2(0, kStep_px);
    const auto after = onPlane(source, hit, ray.movedBy(step.x, step.y));
    const auto before = onPlane(source, hit, ray.movedBy(-step.x, -step.y));
    if (!after || !before) return 1;
    moved[axis] = (*after - *before) / (2 * kStep_px);
  }
  return std::abs(moved[0].x * moved[1].y - moved[0].y * moved[1].x);
}

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::length(glm::normalize(a) - glm::normalize(b));
}

bool areOne(const SourceAnswer& a, const SourceAnswer& b, double slack) {
  return std::abs(a.view_inv_z - b.view_inv_z) <= slack * std::max(a.tolerance, b.tolerance);
}

// An assumed hit where another source has seen the ray free, up to its own hit, is none.
bool isRefuted(const SourceAnswer& answer, const std::vector<SourceAnswer>& answers, double slack) {
  return answer.ray_class == RayClass::kHitAssumed &&
         std::any_of(answers.begin(), answers.end(), [&](const SourceAnswer& other) {
           return other.ray_class == RayClass::kHit && answer.view_inv_z > other.view_inv_z &&
                  answer.view_inv_z <= slack * other.entry_inv_z && !areOne(answer, other, slack);
         });
}

RayClass endOf(const std::vector<SourceAnswer>& answers) {
  for (const RayClass ray_class : {RayClass::kEmpty, RayClass::kHidden}) {
    for (const SourceAnswer& answer : answers) {
      if (answer.ray_class == ray_class) return ray_class;
    }
  }
  return RayClass::kOutside;
}

// The ray's own place where the moved one hits.
OracleHit movedBack(OracleHit hit, const glm::dvec3& move) {
  hit.x_px -= move.x;
  hit.y_px -= move.y;
  hit.inv_z -= move.z;
  return hit;
}

TracedSource tracePinhole(const PosedSource& source, const ViewRay& seen, const glm::dvec3& move) {
  const ProjectedRay projected =
      movedBy(projectRay(source.source->pinhole(), seen.ray), move.x, move.y, move.z);
  const OracleAnswer answer = traceOracle(*source.source, projected);
  TracedSource traced{
      .ray_class = answer.ray_class, .facets = {source.source, source.kappa}, .seen = seen};
  const SeenPart part = seenPart(*source.source, projected);
  if (!part.empty()) {
    const double distance = part.begin / (1 - part.begin);  // the oracle's directions have length 1
    traced.entry_inv_z = glm::length(seen.ray.direction) / distance;
  }
  if (!answer.hits.empty()) traced.hit = movedBack(answer.hits.front(), move);
  return traced;
}

// It sees all around: it has seen the ray from the eye on.
TracedSource traceCubeMap(const OracleCube& cube, const ViewRay& seen, const FaceMove& move) {
  const CubeAnswer answer = traceCube(cube, seen.ray, move);
  return {.ray_class = answer.ray_class,
          .entry_inv_z = kInfinity,
          .facets = {&cube.faces[size_t(answer.face)], cube.kappas[size_t(answer.face)]},
          .seen = seenFromFace(answer.face, seen),
          .hit = answer.face == move.face ? movedBack(answer.hit, move.by) : answer.hit};
}

}  // namespace

ViewRay seenFrom(const PosedSource& source, const ViewRay& ray) {
  const glm::dquat back = glm::conjugate(source.orientation);
  return {{back * (ray.ray.origin_m - source.position_m), back * ray.ray.direction},
          back * ray.direction_per_px_x,
          back * ray.direction_per_px_y};
}

TracedSource traceSource(const PosedSource& source, const ViewRay& ray_world,
                         const FaceMove& move) {
  const ViewRay seen = seenFrom(source, ray_world);
  return source.cube != nullptr ? traceCubeMap(*source.cube, seen, move)
                                : tracePinhole(source, seen, move.by);
}

SourceAnswer sourceAnswer(const TracedSource& traced) {
  SourceAnswer result{.ray_class = traced.ray_class, .entry_inv_z = traced.entry_inv_z};
  if (!isHit(traced.ray_class)) return result;
  const OracleSource& source = *traced.facets.source;
  const ConnectionTolerance& kappas = traced.facets.kappa;
  const OracleHit& hit = traced.hit;
  const Ray& ray = traced.seen.ray;
  const double depth_m = depthInView(source, ray, hit.x_px, hit.y_px, hit.inv_z);
  result.view_inv_z = depth_m > 0 ? 1 / depth_m : kInfinity;
  // Source metres in depth for each of the view's.
  const double depths = hit.inv_z > 0 ? 1 / (hit.inv_z * depth_m) : -ray.direction.z;
  const double kappa = kappas.at(hit.inv_z);
  result.tolerance = std::min(kappa * depths * depths, kToleranceShareMax * result.view_inv_z);
  const glm::dvec3 sight = lineOfSight(source.pinhole(), hit.x_px, hit.y_px);
  const double angle = angleBetween(sight, sight - hit.inv_z * ray.origin_m);
  result.weight = std::clamp(density(source, hit, traced.seen), kDensityMin, 1.0) /
                  (angle * angle + kAngleMin_rad * kAngleMin_rad);
  return result;
}

MergedAnswer mergeAnswers(const std::vector<SourceAnswer>& answers, double slack) {
  MergedAnswer merged{.shares = std::vector<double>(answers.size(), 0)};
  const SourceAnswer* nearest = nullptr;
  for (const SourceAnswer& answer : answers) {
    if (!isHit(answer) || isRefuted(answer, answers, slack)) continue;
    if (!nearest || answer.view_inv_z > nearest->view_inv_z) nearest = &answer;
  }
  if (!nearest) {
    merged.ray_class = endOf(answers);
    return merged;
  }
  const auto blends = [&](const SourceAnswer& answer, RayClass ray_class) {
    return answer.ray_class == ray_class && areOne(answer, *nearest, slack);
  };
  const bool is_certain = std::any_of(answers.begin(), answers.end(),
                                      [&](const auto& a) { return blends(a, RayClass::kHit); });
  merged.ray_class = is_certain ? RayClass::kHit : RayClass::kHitAssumed;
  double sum = 0;
  for (size_t i = 0; i < answers.size(); ++i) {
    if (!blends(answers[i], merged.ray_class)) continue;
    merged.shares[i] = answers[i].weight;
    sum += answers[i].weight;
  }
  for (size_t i = 0; i < answers.size(); ++i) {
    merged.shares[i] /= sum;
    if (merged.shares[i] > 0) merged.view_inv_z += merged.shares[i] * answers[i].view_inv_z;
  }
  return merged;
}

}  // namespace viewloom::oracle
