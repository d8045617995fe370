// SPDX-License-Identifier: Apache-2.0
#include "oracle/merge_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include <glm/geometric.hpp>

#include "oracle/nearby.h"

namespace viewloom::oracle {
namespace {

// A chain of binary32 from the ray to its weight: shares of it, and of 1/Z.
constexpr double kShareTolerance = 0.02;
constexpr double kInvZShareTolerance = 1e-3;
// Whether two hits are one is decided within so much of the tolerance.
constexpr double kSlacks[] = {1, 0.98, 1.02};
constexpr size_t kWorstCount = 6;

bool isExact(const MergedAnswer& tested, const MergedAnswer& own) {
  if (tested.ray_class != own.ray_class) return false;
  if (!isHit(tested.ray_class)) return true;
  bool is_exact = std::abs(tested.view_inv_z - own.view_inv_z) <=
                  kInvZShareTolerance * std::abs(own.view_inv_z);
  for (size_t i = 0; i < tested.shares.size(); ++i) {
    is_exact = is_exact && std::abs(tested.shares[i] - own.shares[i]) <= kShareTolerance;
  }
  return is_exact;
}

// Whether the place and every share lie where they may when each source that has one is anywhere
// among its answers.
bool isAmong(const MergedAnswer& tested, const MergedAnswer& own,
             const std::vector<std::vector<SourceAnswer>>& nearby) {
  if (tested.ray_class != own.ray_class) return false;
  if (!isHit(tested.ray_class)) return true;
  std::vector<Range> weights(own.shares.size());
  Range inv_z;
  for (const auto& answers : nearby) {
    for (size_t i = 0; i < answers.size(); ++i) {
      if (own.shares[i] <= 0) continue;
      inv_z.include(answers[i].view_inv_z);
      weights[i].include(answers[i].weight);
    }
  }
  const double slack = kInvZShareTolerance * std::abs(inv_z.high);
  if (tested.view_inv_z < inv_z.low - slack || tested.view_inv_z > inv_z.high + slack) return false;
  for (size_t i = 0; i < weights.size(); ++i) {
    double others_low = 0, others_high = 0;
    for (size_t j = 0; j < weights.size(); ++j) {
      if (j == i || own.shares[j] <= 0) continue;
      others_low += weights[j].low;
      others_high += weights[j].high;
    }
    const bool has_share = own.shares[i] > 0;
    const double low = has_share ? weights[i].low / (weights[i].low + others_high) : 0;
    const double high = has_share ? weights[i].high / (weights[i].high + others_low) : 0;
    if (tested.shares[i] < low - kShareTolerance || tested.shares[i] > high + kShareTolerance) {
      return false;
    }
  }
  return true;
}

bool agree(const MergedAnswer& a, const MergedAnswer& b) {
  if (a.ray_class != b.ray_class) return false;
  return std::equal(a.shares.begin(), a.shares.end(), b.shares.begin(),
                    [](double one, double other) { return (one > 0) == (other > 0); });
}

// By how much a plane that is taken for the facet at a hit may be off there, 1/m: half of the
// connection tolerance, or what moves the picture by the display's tolerance. Seen from b, a point
// r / w stands beside itself by |r x b| dw / |r - w b|^2 radian when w is off by dw.
double planeError(const PosedSource& source, const ViewRay& ray, double output_px) {
  const OracleAnswer answer = traceOracle(*source.source, ray.ray);
  if (answer.hits.empty()) return 0;
  const OracleHit& hit = answer.hits.front();
  const Pinhole& pinhole = source.source->pinhole();
  const glm::dvec3 sight{(hit.x_px - pinhole.principal_px.x) / pinhole.focal_px.x,
                         -(hit.y_px - pinhole.principal_px.y) / pinhole.focal_px.y, -1.0};
  const glm::dvec3 from_eye = sight - hit.inv_z * ray.ray.origin_m;
  const double turn =
      glm::length(glm::cross(sight, ray.ray.origin_m)) / glm::dot(from_eye, from_eye);
  const double px =
      std::max(glm::length(ray.direction_per_px_x), glm::length(ray.direction_per_px_y)) /
      glm::length(ray.ray.direction);
  const double half_kappa =
      0.5 * std::max<double>(source.kappa.absolute, source.kappa.relative * hit.inv_z);
  return turn > 0 ? std::min(half_kappa, output_px * px / turn) : half_kappa;
}

std::string describe(const MergedAnswer& answer) {
  std::ostringstream text;
  text << answer.ray_class;
  if (isHit(answer.ray_class)) text << " at " << answer.view_inv_z << " 1/m, shares";
  for (const double share : answer.shares) text << " " << share;
  return text.str();
}

}  // namespace

MergeJudge::MergeJudge(std::vector<PosedSource> sources, double output_px)
    : sources_(std::move(sources)) {
  for (const PosedSource& source : sources_) {
    tolerances_.push_back(toleranceOf(*source.source, output_px));
  }
}

SourceAnswer MergeJudge::answerOf(const PosedSource& source, const ViewRay& ray,
                                  const glm::dvec3& moved_by) const {
  const ViewRay seen = seenFrom(source, ray);
  const ProjectedRay projected =
      movedBy(projectRay(source.source->pinhole(), seen.ray), moved_by.x, moved_by.y, moved_by.z);
  OracleAnswer answer = traceOracle(*source.source, projected);
  for (OracleHit& hit : answer.hits) {  // the ray's own place where the moved one hits
    hit.x_px -= moved_by.x;
    hit.y_px -= moved_by.y;
    hit.inv_z -= moved_by.z;
  }
  return sourceAnswer(source, seen, projected, answer);
}

std::vector<SourceAnswer> MergeJudge::answersTo(const ViewRay& ray) const {
  std::vector<SourceAnswer> answers;
  for (const PosedSource& source : sources_) {
    answers.push_back(answerOf(source, ray, glm::dvec3(0.0)));
  }
  return answers;
}

// Planes stand for several facets, and a hit at an edge names the facet on either side: how densely
// a source samples the surface may be told by any that is linked to the hit's.
std::vector<SourceAnswer> MergeJudge::answersOfLinked(const PosedSource& source,
                                                      const ViewRay& ray) const {
  const ViewRay seen = seenFrom(source, ray);
  const ProjectedRay projected = projectRay(source.source->pinhole(), seen.ray);
  OracleAnswer answer = traceOracle(*source.source, projected);
  std::vector<SourceAnswer> answers;
  if (answer.hits.empty()) return answers;
  const FacetAt own = answer.hits.front().facet;
  for (int i = 0; i < 4; ++i) {
    FacetAt beside{0, own.column + (i == 0) - (i == 1), own.row + (i == 2) - (i == 3)};
    if (beside.column < 0 || beside.column >= source.source->width()) continue;
    if (beside.row < 0 || beside.row >= source.source->height()) continue;
    for (; beside.layer < source.source->layerCount(); ++beside.layer) {
      if (!source.source->linked(own, beside)) continue;
      answer.hits.front().facet = beside;
      answers.push_back(sourceAnswer(source, seen, projected, answer));
    }
  }
  return answers;
}

// Of the ray, of rays that the picture moved by its tolerance sees, and where one of the sources
// has rounded, or its surfaces are off by what moves the picture by its tolerance.
std::vector<std::vector<SourceAnswer>> MergeJudge::answersNearby(const ViewRay& ray) const {
  const std::vector<SourceAnswer> own = answersTo(ray);
  std::vector<std::vector<SourceAnswer>> nearby = {own};
  const double output_px = tolerances_.front().output_px;
  for (const glm::dvec2& move_px : movesWithin(output_px)) {
    ViewRay moved = ray;
    moved.ray = ray.movedBy(move_px.x, move_px.y);
    nearby.push_back(answersTo(moved));
  }
  for (size_t i = 0; i < sources_.size(); ++i) {
    const JudgeTolerance& tolerance = tolerances_[i];
    const double plane = planeError(sources_[i], seenFrom(sources_[i], ray), output_px);
    for (const double sign : {-1.0, 1.0}) {
      for (const glm::dvec3& step :
           {glm::dvec3(tolerance.source_px, 0, 0), glm::dvec3(0, tolerance.source_px, 0),
            glm::dvec3(0, 0, tolerance.inv_z), glm::dvec3(0, 0, plane),
            glm::dvec3(0, 0, 0.5 * plane), glm::dvec3(0, 0, 0.25 * plane)}) {
        nearby.push_back(own);
        nearby.back()[i] = answerOf(sources_[i], ray, sign * step);
      }
    }
    for (const SourceAnswer& answer : answersOfLinked(sources_[i], ray)) {
      nearby.push_back(own);
      nearby.back()[i] = answer;
    }
  }
  return nearby;
}

void MergeJudge::consider(const ViewRay& ray, const MergedAnswer& tested,
                          const std::string& where) {
  ++verdict_.rays;
  const MergedAnswer own = mergeAnswers(answersTo(ray));
  if (isExact(tested, own)) {
    ++verdict_.exact;
    return;
  }
  const std::vector<std::vector<SourceAnswer>> nearby = answersNearby(ray);
  bool all_agree = true;
  for (const double slack : kSlacks) {
    for (const auto& answers : nearby) {
      all_agree = all_agree && agree(own, mergeAnswers(answers, slack));
    }
  }
  if (!all_agree) {
    ++verdict_.excused;
    return;
  }
  if (isAmong(tested, own, nearby)) {
    ++verdict_.within;
    return;
  }
  ++verdict_.differing;
  if (verdict_.worst.size() < kWorstCount) {
    verdict_.worst.push_back(where + ": oracle " + describe(own) + ", tested " + describe(tested));
  }
}

}  // namespace viewloom::oracle
