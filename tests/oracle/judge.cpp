// SPDX-License-Identifier: Apache-2.0
#include "oracle/judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "oracle/answer_text.h"
#include "oracle/nearby.h"
#include "oracle/surface_behind.h"

namespace viewloom::oracle {
namespace {

// Units in the last place of binary32 that a chain of clip, step and solve may lose.
constexpr double kRoundingUlps = 16;
constexpr double kUlp = 1.0 / (1 << 23);

// Where a ray is compared with a surface on its way.
constexpr double kStepsPerPx = 4;

bool namesLayer(const OracleHit& hit, int layer) {
  return hit.facet.layer == layer || hit.linked_facet.layer == layer;
}

// Follows links from `from` to the column (column, row), first along one axis, then along the
// other.
FacetAt followLinks(const OracleSource& source, FacetAt from, int column, int row, bool x_first) {
  while (from.layer >= 0 && (from.column != column || from.row != row)) {
    FacetAt next{-1, from.column, from.row};
    const bool along_x = x_first ? from.column != column : from.row == row;
    (along_x ? next.column : next.row) +=
        along_x ? (column > from.column ? 1 : -1) : (row > from.row ? 1 : -1);
    FacetAt found;
    for (int layer = 0; layer < source.layerCount() && found.layer < 0; ++layer) {
      next.layer = layer;
      if (source.linked(from, next)) found = next;
    }
    from = found;
  }
  return from;
}

}  // namespace

bool onOneSurface(const OracleSource& source, const FacetAt& a, const FacetAt& b) {
  return followLinks(source, a, b.column, b.row, true) == b ||
         followLinks(source, a, b.column, b.row, false) == b;
}

JudgeTolerance toleranceOf(const OracleSource& source, double output_px) {
  double largest = 0;
  for (const float inv_z : source.planes().inv_z) largest = std::max(largest, double(inv_z));
  const double extent_px = std::max(source.width(), source.height());
  return {output_px, kRoundingUlps * kUlp * extent_px, kRoundingUlps * kUlp * largest};
}

void Verdict::add(const Verdict& other) {
  rays += other.rays;
  exact += other.exact;
  within += other.within;
  excused += other.excused;
  differing += other.differing;
  for (const std::string& line : other.worst) {
    if (worst.size() < Verdict::kWorstCount) worst.push_back(line);
  }
}

std::string Verdict::summary() const {
  std::ostringstream text;
  text << rays << " rays: " << exact << " exact, " << within << " within tolerance, " << excused
       << " excused (" << 100 * excusedShare() << " %), " << differing << " differing";
  for (const std::string& line : worst) text << "\n  " << line;
  return text.str();
}

OracleAnswer Judge::answerFrom(const ProjectedRay& ray) const {
  return traceFromSurface(source_, ray, *surface_layer_);
}

OracleAnswer Judge::answerFrom(const Ray& ray) const {
  return answerFrom(projectRay(source_.pinhole(), ray));
}

template <typename AnyRay>
OracleAnswer Judge::answerOf(const AnyRay& ray) const {
  if (surface_layer_) return answerFrom(ray);
  if (asked_ == AskedSurface::kFirst) return traceOracle(source_, ray);
  return behindFirst(source_, traceOracle(source_, ray, kThroughMax));
}

void Judge::considerFrom(int surface_layer, const ViewRay& ray, const TestedAnswer& tested,
                         const std::string& where) {
  surface_layer_ = surface_layer;
  consider(ray, tested, where);
  surface_layer_.reset();
}

void Judge::consider(const ViewRay& ray, const TestedAnswer& tested, const std::string& where) {
  ++verdict_.rays;
  const OracleAnswer own = answerOf(ray.ray);
  if (matches(own, tested)) {
    ++verdict_.exact;
    return;
  }
  if (skims(own, ray, tested)) {
    ++verdict_.within;
    return;
  }
  const std::vector<OracleAnswer> answers = answersOfMovedRays(ray);
  if (!agreeing(answers)) {
    ++verdict_.excused;
    return;
  }
  if (amongThem(answers, ray, tested)) {
    ++verdict_.within;
    return;
  }
  ++verdict_.differing;
  if (verdict_.worst.size() < Verdict::kWorstCount) {
    verdict_.worst.push_back(where + ": oracle " + describe(own) + ", tested " + describe(tested) +
                             ", " + describe(ray.ray));
  }
}

bool Judge::matches(const OracleAnswer& oracle, const TestedAnswer& tested) const {
  if (oracle.ray_class != tested.ray_class) return false;
  if (!isHit(oracle.ray_class)) return true;
  const OracleHit& hit = oracle.hits.front();
  return namesLayer(hit, tested.layer) && hit.is_back == tested.is_back &&
         std::abs(hit.x_px - tested.x_px) <= tolerance_.source_px &&
         std::abs(hit.y_px - tested.y_px) <= tolerance_.source_px &&
         std::abs(hit.inv_z - tested.inv_z) <= tolerance_.inv_z;
}

// The ray itself, its picture moved all around by the tolerance and by shares of it (further out a
// ray may hit again what a nearer one misses), and itself moved by what rounding may do to a
// position. A surface off by dw in 1/Z moves the picture along the epipolar line, so moved pictures
// also stand for surfaces that are off by as much as the tolerance allows.
std::vector<OracleAnswer> Judge::answersOfMovedRays(const ViewRay& ray) const {
  std::vector<OracleAnswer> answers = {answerOf(ray.ray)};
  for (const glm::dvec2& move_px : movesWithin(tolerance_.output_px)) {
    answers.push_back(answerOf(ray.movedBy(move_px.x, move_px.y)));
  }
  const ProjectedRay own = projectRay(source_.pinhole(), ray.ray);
  for (const double sign : {-1.0, 1.0}) {
    answers.push_back(answerOf(movedBy(own, sign * tolerance_.source_px, 0, 0)));
    answers.push_back(answerOf(movedBy(own, 0, sign * tolerance_.source_px, 0)));
    answers.push_back(answerOf(movedBy(own, 0, 0, sign * tolerance_.inv_z)));
  }
  return answers;
}

bool Judge::agreeing(const std::vector<OracleAnswer>& answers) const {
  const OracleAnswer& own = answers.front();
  return std::all_of(answers.begin(), answers.end(), [&](const OracleAnswer& moved) {
    if (moved.ray_class != own.ray_class) return false;
    return own.hits.empty() ||
           (own.hits.front().is_back == moved.hits.front().is_back &&
            onOneSurface(source_, own.hits.front().facet, moved.hits.front().facet));
  });
}

// How far a point of the source may be off in 1/Z along its own column until the picture moves by
// the tolerance, 1/m. Seen from b, P / (1 + dw Z) stands beside P by |P x b| dw Z / |P - b|^2
// radian; a px is |direction per px| / |direction| radian.
double Judge::invZTolerance(const ViewRay& ray, const TestedAnswer& tested) const {
  const double infinity = std::numeric_limits<double>::infinity();
  const Pinhole& pinhole = source_.pinhole();
  const glm::dvec3 point{(tested.x_px - pinhole.principal_px.x) / pinhole.focal_px.x,
                         -(tested.y_px - pinhole.principal_px.y) / pinhole.focal_px.y, -1.0};
  const glm::dvec3 from_eye = point - tested.inv_z * ray.ray.origin_m;  // times Z
  const double turn = glm::length(glm::cross(point, ray.ray.origin_m)) /
                      glm::dot(from_eye, from_eye);  // radian per 1/m
  const double px =
      std::max(glm::length(ray.direction_per_px_x), glm::length(ray.direction_per_px_y)) /
      glm::length(ray.ray.direction);
  return turn > 0 ? tolerance_.output_px * px / turn : infinity;
}

// Whether the layer that an answer names has its surface where the answer lies: where two layers
// meet within the tolerance, either may be named; and at an edge, the facet on either side.
bool Judge::standsThere(const TestedAnswer& tested, double inv_z_tolerance) const {
  if (tested.layer < 0 || tested.layer >= source_.layerCount()) return false;
  const auto column = [&](double x_px) { return std::clamp(int(x_px), 0, source_.width() - 1); };
  const auto row = [&](double y_px) { return std::clamp(int(y_px), 0, source_.height() - 1); };
  for (const double x_px :
       {tested.x_px - tolerance_.source_px, tested.x_px + tolerance_.source_px}) {
    for (const double y_px :
         {tested.y_px - tolerance_.source_px, tested.y_px + tolerance_.source_px}) {
      const FacetAt at{tested.layer, column(x_px), row(y_px)};
      if (source_.exists(at) && std::abs(source_.planeInvZ(at, tested.x_px, tested.y_px) -
                                         tested.inv_z) <= inv_z_tolerance) {
        return true;
      }
    }
  }
  return false;
}

// Two points of the seen part, (x, y, 1/Z). Its ends may lie at the camera's plane; what lies
// between is finite.
std::array<glm::dvec3, 2> Judge::pointsOf(const ProjectedRay& ray) const {
  const SeenPart seen = seenPart(source_, ray);
  const auto at = [&](double share) {
    const HomogeneousPoint p = ray.at(glm::mix(seen.begin, seen.end, share));
    return glm::dvec3(p.u / p.z, p.v / p.z, p.h / p.z);
  };
  return {at(0.25), at(0.75)};
}

// Whether a position lies on a ray, up to rounding: its distance from the straight line in
// (x, y, 1/Z), in units of the rounding along each axis.
bool Judge::liesOn(const ProjectedRay& ray, const glm::dvec3& position) const {
  const glm::dvec3 unit(tolerance_.source_px, tolerance_.source_px, tolerance_.inv_z);
  const auto [one, other] = pointsOf(ray);
  const glm::dvec3 along = (other - one) / unit;
  const glm::dvec3 beside = glm::cross((position - one) / unit, along);
  return glm::length(beside) <= std::sqrt(3.0) * glm::length(along);
}

// Whether the answer is the ray's own hit on a surface that is off by no more than the tolerance,
// however far from where the ray hits the true one: where a ray skims a rough surface, tips that
// are lower or higher move the hit by many px, which no moved ray shows. The answer lies on the ray
// and on a surface within the tolerance; beyond the true hit, so does all the way there.
bool Judge::skims(const OracleAnswer& own, const ViewRay& ray, const TestedAnswer& tested) const {
  if (!isHit(own.ray_class) || own.ray_class != tested.ray_class) return false;
  if (own.hits.front().is_back != tested.is_back) return false;
  const ProjectedRay projected = projectRay(source_.pinhole(), ray.ray);
  const double inv_z_tolerance = tolerance_.inv_z + invZTolerance(ray, tested);
  const glm::dvec3 answer(tested.x_px, tested.y_px, tested.inv_z);
  if (!standsThere(tested, inv_z_tolerance) || !liesOn(projected, answer)) return false;
  const OracleHit& hit = own.hits.front();
  const glm::dvec3 beyond = answer - glm::dvec3(hit.x_px, hit.y_px, hit.inv_z);
  const auto [one, other] = pointsOf(projected);
  if (glm::dot(beyond, other - one) <= 0) return true;
  const int step_count = 1 + int(kStepsPerPx * glm::length(glm::dvec2(beyond)));
  for (int step = 0; step < step_count; ++step) {
    const glm::dvec3 point = answer - beyond * (double(step) / step_count);
    bool is_near = false;
    for (int layer = 0; layer < source_.layerCount(); ++layer) {
      const TestedAnswer there{tested.ray_class, layer, point.x, point.y, point.z};
      is_near = is_near || standsThere(there, inv_z_tolerance);
    }
    if (!is_near) return false;
  }
  return true;
}

// Whether the tested answer lies among those of the moved rays, which agree with each other.
bool Judge::amongThem(const std::vector<OracleAnswer>& answers, const ViewRay& ray,
                      const TestedAnswer& tested) const {
  if (tested.ray_class != answers.front().ray_class) return false;
  if (!isHit(tested.ray_class)) return true;
  Range x_px, y_px, inv_z;
  const double inv_z_tolerance = tolerance_.inv_z + invZTolerance(ray, tested);
  if (answers.front().hits.front().is_back != tested.is_back) return false;
  bool layer_named = standsThere(tested, inv_z_tolerance);
  for (const OracleAnswer& answer : answers) {
    const OracleHit& hit = answer.hits.front();
    x_px.include(hit.x_px);
    y_px.include(hit.y_px);
    inv_z.include(hit.inv_z);
    layer_named = layer_named || namesLayer(hit, tested.layer);
  }
  return layer_named && x_px.holds(tested.x_px, tolerance_.source_px) &&
         y_px.holds(tested.y_px, tolerance_.source_px) &&
         inv_z.holds(tested.inv_z, inv_z_tolerance);
}

}  // namespace viewloom::oracle
