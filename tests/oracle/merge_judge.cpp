// SPDX-License-Identifier: Apache-2.0
#include "oracle/merge_judge.h"

#include <algorithm>
#include <cmath>
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

// The pinholes that a source has: itself, or the faces of a cube map.
std::vector<SeenFacets> pinholesOf(const PosedSource& source) {
  if (source.cube == nullptr) return {{source.source, source.kappa}};
  std::vector<SeenFacets> faces;
  for (size_t face = 0; face < source.cube->faces.size(); ++face) {
    faces.push_back({&source.cube->faces[face], source.cube->kappas[face]});
  }
  return faces;
}

// Planes stand for several facets, and a hit at an edge names the facet on either side: how densely
// a source samples the surface may be told by any that is linked to the hit's.
std::vector<SourceAnswer> answersOfLinked(TracedSource traced) {
  std::vector<SourceAnswer> answers;
  if (!isHit(traced.ray_class)) return answers;
  const OracleSource& source = *traced.facets.source;
  const FacetAt own = traced.hit.facet;
  for (int i = 0; i < 4; ++i) {
    FacetAt beside{0, own.column + (i == 0) - (i == 1), own.row + (i == 2) - (i == 3)};
    if (beside.column < 0 || beside.column >= source.width()) continue;
    if (beside.row < 0 || beside.row >= source.height()) continue;
    for (; beside.layer < source.layerCount(); ++beside.layer) {
      if (!source.linked(own, beside)) continue;
      traced.hit.facet = beside;
      answers.push_back(sourceAnswer(traced));
    }
  }
  return answers;
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
    : sources_(std::move(sources)), output_px_(output_px) {}

std::vector<SourceAnswer> MergeJudge::answersTo(const ViewRay& ray) const {
  std::vector<SourceAnswer> answers;
  for (const PosedSource& source : sources_) {
    answers.push_back(sourceAnswer(traceSource(source, ray)));
  }
  return answers;
}

// Where one of its pinholes has rounded, or its surfaces are off at these places of the ray, 1/Z of
// the view, by what moves the picture by its tolerance.
std::vector<SourceAnswer> MergeJudge::answersOfMoved(size_t source, const ViewRay& ray,
                                                     const std::vector<double>& view_inv_zs) const {
  const PosedSource& posed = sources_[source];
  const std::vector<SeenFacets> pinholes = pinholesOf(posed);
  const ViewRay seen = seenFrom(posed, ray);
  std::vector<SourceAnswer> answers;
  for (int i = 0; i < int(pinholes.size()); ++i) {
    const SeenFacets& pinhole = pinholes[size_t(i)];
    const JudgeTolerance tolerance = toleranceOf(*pinhole.source, output_px_);
    const double plane = planeErrorAt(pinhole, posed.cube != nullptr ? seenFromFace(i, seen) : seen,
                                      view_inv_zs, output_px_);
    for (const double sign : {-1.0, 1.0}) {
      for (const glm::dvec3& step :
           {glm::dvec3(tolerance.source_px, 0, 0), glm::dvec3(0, tolerance.source_px, 0),
            glm::dvec3(0, 0, tolerance.inv_z), glm::dvec3(0, 0, plane),
            glm::dvec3(0, 0, 0.5 * plane), glm::dvec3(0, 0, 0.25 * plane)}) {
        answers.push_back(sourceAnswer(traceSource(posed, ray, {i, sign * step})));
      }
    }
  }
  return answers;
}

// Answers to the ray, to the rays of a picture moved by its tolerance, and with one of the sources
// moved a little.
std::vector<std::vector<SourceAnswer>> MergeJudge::answersNearby(const ViewRay& ray,
                                                                 const MergedAnswer& tested) const {
  const std::vector<SourceAnswer> own = answersTo(ray);
  std::vector<std::vector<SourceAnswer>> nearby = {own};
  for (const glm::dvec2& move_px : movesWithin(output_px_)) {
    ViewRay moved = ray;
    moved.ray = ray.movedBy(move_px.x, move_px.y);
    nearby.push_back(answersTo(moved));
  }
  for (size_t i = 0; i < sources_.size(); ++i) {
    std::vector<double> view_inv_zs;
    if (isHit(own[i].ray_class)) view_inv_zs.push_back(own[i].view_inv_z);
    if (isHit(tested.ray_class)) view_inv_zs.push_back(tested.view_inv_z);
    std::vector<SourceAnswer> others = answersOfMoved(i, ray, view_inv_zs);
    const std::vector<SourceAnswer> linked = answersOfLinked(traceSource(sources_[i], ray));
    others.insert(others.end(), linked.begin(), linked.end());
    for (const SourceAnswer& other : others) {
      nearby.push_back(own);
      nearby.back()[i] = other;
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
  const std::vector<std::vector<SourceAnswer>> nearby = answersNearby(ray, tested);
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
  if (verdict_.worst.size() < Verdict::kWorstCount) {
    verdict_.worst.push_back(where + ": oracle " + describe(own) + ", tested " + describe(tested));
  }
}

}  // namespace viewloom::oracle
