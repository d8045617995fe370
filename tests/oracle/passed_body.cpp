// SPDX-License-Identifier: Apache-2.0
#include "oracle/passed_body.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

namespace viewloom::oracle {
namespace {

constexpr int kReach_px = 128;
constexpr double kStepShare = 0.25;
constexpr double kStepMin_px = 0.5;
constexpr double kFirst_px = 0.02;
constexpr double kRoundMax_px = 1.25;

bool isInImage(const OracleSource& source, const glm::dvec2& px) {
  return px.x >= 0 && px.y >= 0 && px.x < source.width() && px.y < source.height();
}

// 1/Z of the first layer; beside the image it is that of its border. None: no surface there.
std::optional<double> surfaceAt(const OracleSource& source, const glm::dvec2& px) {
  const FacetAt at{0, int(std::clamp(std::floor(px.x), 0.0, source.width() - 1.0)),
                   int(std::clamp(std::floor(px.y), 0.0, source.height() - 1.0))};
  if (!source.exists(at)) return std::nullopt;
  return std::max(source.planeInvZ(at, px.x, px.y), 0.0);
}

glm::dvec3 metres(const OracleSource& source, const glm::dvec3& place) {
  const auto& [focal_px, principal_px] = source.pinhole();
  const glm::dvec2 at = (glm::dvec2(place) - principal_px) / focal_px;
  return glm::dvec3(at, 1.0) / place.z;
}

struct Rim {
  double at_px = 0;
  double inv_z = 0;
  bool is_round = false;
};

// The body along a line in the image.
class Body {
 public:
  Body(const OracleSource& source, const glm::dvec2& edge_px, const glm::dvec2& along)
      : source_(source), edge_px_(edge_px), along_(along) {}

  // Whether it is nearer than a ray that passes, and seen as far as its other rim.
  bool isWhole(double passed_inv_z) {
    const std::optional<double> first = surfaceAt(source_, placeOf(0.5));
    if (!first || *first <= passed_inv_z) return false;
    int outside = 1;
    while (!endsBefore(outside, *first)) {
      if (outside >= kReach_px || !isInImage(source_, placeOf(outside + 0.5))) return false;
      outside *= 2;
    }
    if (!isInImage(source_, placeOf(outside + 0.5))) return false;
    int inside = outside / 2;
    while (outside - inside > 1) {
      const int middle = (inside + outside) / 2;
      (endsBefore(middle, *first) ? outside : inside) = middle;
    }
    length_ = inside;
    near_ = rim({0, std::min(1, inside), std::min(2, inside)}, -1);
    far_ = rim({inside, inside - std::min(1, inside), inside - std::min(2, inside)}, 1);
    return true;
  }

  // Whether its rims are somewhere.
  bool hasRims() const { return near_.inv_z > 0 && far_.inv_z > 0; }

  // Whether a ray was in front of its near rim, and behind it where it passed the last sample.
  bool isCutOff(const glm::dvec3& begin, const glm::dvec3& passed, const glm::dvec3& per_px) const {
    const double forward = glm::dot(glm::dvec2(per_px), along_) / glm::dot(along_, along_);
    const glm::dvec3 at_rim = passed + near_.at_px / forward * per_px;
    const bool was_there = glm::dot(glm::dvec2(at_rim - begin), glm::dvec2(per_px)) >= 0;
    return near_.at_px < 0 && was_there && at_rim.z >= near_.inv_z;
  }

  // Whether a place behind its front is in it.
  bool contains(const glm::dvec3& place) const {
    const glm::dvec3 near_place(edge_px_ + near_.at_px * along_, near_.inv_z);
    const glm::dvec3 far_place(edge_px_ + far_.at_px * along_, far_.inv_z);
    glm::dvec3 opposite = near_place + far_place - place;
    if (!near_.is_round && !far_.is_round) {
      const glm::dvec3 at_m =
          metres(source_, near_place) + metres(source_, far_place) - metres(source_, place);
      if (at_m.z <= 0) return false;
      const auto& [focal_px, principal_px] = source_.pinhole();
      opposite = {focal_px * glm::dvec2(at_m) / at_m.z + principal_px, 1 / at_m.z};
    }
    const double at_px =
        glm::dot(glm::dvec2(opposite) - edge_px_, along_) / glm::dot(along_, along_);
    if (at_px < near_.at_px || at_px > far_.at_px) return false;
    const double last_px = length_ + 0.5;
    if (at_px <= last_px) {
      return opposite.z <= surfaceAt(source_, placeOf(std::max(at_px, 0.5))).value_or(kNoSurface);
    }
    const double beyond = (far_.at_px - at_px) / (far_.at_px - last_px);
    const double last = surfaceAt(source_, placeOf(last_px)).value_or(kNoSurface);
    return opposite.z <= far_.inv_z + (last - far_.inv_z) * std::sqrt(beyond);
  }

 private:
  glm::dvec2 placeOf(double px) const { return edge_px_ + px * along_; }

  // Further behind its first sample than away from it.
  bool endsBefore(int sample, double first) const {
    const glm::dvec2 at = placeOf(sample + 0.5);
    const std::optional<double> inv_z = surfaceAt(source_, at);
    const double way_m =
        glm::distance(metres(source_, {at, first}), metres(source_, {placeOf(0.5), first}));
    return !inv_z || *inv_z * (1 / first + way_m) < 1;
  }

  // An ellipse, where three samples from the last one inwards lie on one.
  Rim rim(const glm::ivec3& samples, int outwards) const {
    const auto inverse = [&](int i) {
      return surfaceAt(source_, placeOf(samples[i] + 0.5)).value_or(kNoSurface);
    };
    const double a = inverse(1) - inverse(0);
    const double b = inverse(2) - inverse(1);
    const double first = 1 - 2.0 / (length_ + 1);
    const double then = 1 - 4.0 / (length_ + 1);
    const double bends = 2 * (a * then - b * first);
    const double fall = (b * (b + 2 * a) * first - a * a * then) / bends;
    const double squares = fall * fall / (a * a + 2 * a * fall) * first;
    const double beyond_px = squares + squares * squares / (length_ + 1);
    const bool is_round = bends > 0 && b > 0 && fall >= 0 && beyond_px <= kRoundMax_px;
    const double last_px = samples[0] + 0.5;
    if (is_round) return {last_px + outwards * std::min(beyond_px, 1.0), inverse(0) - fall, true};
    return {last_px + outwards * 0.5, inverse(0) - 0.5 * a, false};
  }

  const OracleSource& source_;
  glm::dvec2 edge_px_;
  glm::dvec2 along_;
  int length_ = 0;  // from the first sample to the last one
  Rim near_;
  Rim far_;
};

}  // namespace

bool BodyAnswer::agrees(const BodyAnswer& other, double tolerance_px) const {
  return behind == other.behind &&
         (behind != BehindBody::kMet ||
          glm::distance(glm::dvec2(place), glm::dvec2(other.place)) <= tolerance_px);
}

BodyAnswer behindBody(const OracleSource& source, const glm::dvec3& begin, const glm::dvec3& passed,
                      const glm::dvec3& end) {
  const glm::dvec3 way = end - passed;
  const double way_px = std::max(std::abs(way.x), std::abs(way.y));
  const glm::dvec3 per_px = way / way_px;
  const auto offEdge = [](double px) { return std::abs(px - std::round(px)); };
  const bool across_x = offEdge(passed.x) < offEdge(passed.y);
  const glm::dvec2 across =
      across_x ? glm::dvec2(way.x < 0 ? -1 : 1, 0) : glm::dvec2(0, way.y < 0 ? -1 : 1);
  for (const glm::dvec2& along : {glm::dvec2(per_px), across}) {
    Body body(source, glm::dvec2(passed), along);
    if (!body.isWhole(passed.z)) continue;
    if (!body.hasRims()) return {};
    const bool is_cut_off = body.isCutOff(begin, passed, per_px);
    for (double px = kFirst_px; px < way_px && px <= kReach_px;
         px += std::max(kStepShare * px, kStepMin_px)) {
      const glm::dvec3 place = passed + px * per_px;
      if (is_cut_off || body.contains(place)) return {BehindBody::kMet, place};
    }
    return {BehindBody::kPassed, {}};
  }
  return {};
}

}  // namespace viewloom::oracle
