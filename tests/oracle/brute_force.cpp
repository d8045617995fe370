// SPDX-License-Identifier: Apache-2.0
#include "oracle/brute_force.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

namespace viewloom::oracle {
namespace {

// Share of the seen part: far above rounding, far below the way through a column.
constexpr double kJustBefore = 1e-9;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A half space n . P + d >= 0 in metres.
struct HalfSpace {
  glm::dvec3 normal;
  double distance = 0;
};

// The pyramid over a rectangle of the image, as four half spaces through the camera.
struct Pyramid {
  HalfSpace sides[4];
};

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

// Distances along the ray between which it is inside; empty when begin >= end.
struct Stretch {
  double begin = 0;
  double end = kInfinity;
  bool empty() const { return !(begin < end); }
};

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

// The metric plane of a facet, n . P + d, positive on the camera's side of it.
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

struct Event {
  double distance = kInfinity;
  FacetAt facet;
};

class AllFacets {
 public:
  AllFacets(const OracleSource& source, const Ray& ray)
      : source_(source), ray_(ray), behind_from_(size_t(source.layerCount()), kInfinity) {}

  OracleAnswer run() {
    const Stretch seen =
        insideOf(pyramidOver(source_.pinhole(), 0, 0, source_.width(), source_.height()), ray_);
    OracleAnswer answer;
    if (seen.empty()) return answer;
    last_ = seen.end == kInfinity ? kInfinity : seen.end - kJustBefore * (seen.end - seen.begin);
    visitFacets([&](const FacetAt& at) { considerBegin(at); });
    visitFacets([&](const FacetAt& at) { considerFacet(at); });
    visitFacets([&](const FacetAt& at) {
      considerEdges(at, {-1, at.column + 1, at.row});
      considerEdges(at, {-1, at.column, at.row + 1});
    });
    if (first_) {
      const bool assumed = behind_from_[0] < first_->distance;
      answer.ray_class = assumed ? RayClass::kHitAssumed : RayClass::kHit;
      answer.hits.push_back(hitAt(*first_, assumed));
    } else if (behind_at_end_) {
      answer.ray_class = RayClass::kHidden;
    } else {
      answer.ray_class = seen.end == kInfinity ? RayClass::kEmpty : RayClass::kOutside;
    }
    return answer;
  }

 private:
  template <typename Visit>
  void visitFacets(Visit visit) {
    for (int layer = 0; layer < source_.layerCount(); ++layer) {
      for (int row = 0; row < source_.height(); ++row) {
        for (int column = 0; column < source_.width(); ++column) {
          const FacetAt at{layer, column, row};
          if (source_.exists(at)) visit(at);
        }
      }
    }
  }

  Stretch inColumn(const FacetAt& at) const {
    return insideOf(pyramidOver(source_.pinhole(), at.column, at.row, at.column + 1, at.row + 1),
                    ray_);
  }

  void offer(const Event& event) {
    if (!first_ || event.distance < first_->distance) first_ = event;
  }

  // Where all layers before this one have once been passed, and it counts.
  double countsFrom(const FacetAt& at) const {
    return at.layer == 0 ? 0 : behind_from_[size_t(at.layer - 1)];
  }

  // Layer by layer, nearest first.
  void considerBegin(const FacetAt& at) {
    const double begin = inColumn(at).begin;
    if (inColumn(at).empty() || begin < countsFrom(at)) return;
    if (sideAt(metricPlane(source_, at), ray_, begin) > 0) return;
    double& behind_from = behind_from_[size_t(at.layer)];
    behind_from = std::min(behind_from, begin);
  }

  void considerFacet(const FacetAt& at) {
    const Stretch inside = inColumn(at);
    if (inside.empty()) return;
    const HalfSpace plane = metricPlane(source_, at);
    const double at_begin = sideAt(plane, ray_, inside.begin);
    const double at_end = sideAt(plane, ray_, inside.end);
    const bool last = inside.begin < last_ && inside.end >= last_;
    const bool counts = countsFrom(at) <= inside.begin;
    if (counts && at_begin <= 0 && at_end <= 0 && last) behind_at_end_ = true;
    if (at_end > 0) {
      if (counts && inside.end == kInfinity) offer({kInfinity, at});
      return;
    }
    if (at_begin <= 0) return;
    const double per_step = glm::dot(plane.normal, ray_.direction);
    if (!counts) return;
    offer({-(glm::dot(plane.normal, ray_.origin_m) + plane.distance) / per_step, at});
  }

  void considerEdges(const FacetAt& at, const FacetAt& beside) {
    if (beside.column >= source_.width() || beside.row >= source_.height()) return;
    for (int layer = 0; layer < source_.layerCount(); ++layer) {
      const FacetAt other{layer, beside.column, beside.row};
      if (!source_.linked(at, other)) continue;
      const Stretch here = inColumn(at);
      const Stretch there = inColumn(other);
      if (here.empty() || there.empty()) continue;
      const bool leaves = here.begin < there.begin;
      const FacetAt& from = leaves ? at : other;
      const FacetAt& to = leaves ? other : at;
      const double distance = leaves ? there.begin : here.begin;
      if (countsFrom(to) > distance) continue;
      const bool from_counts = countsFrom(from) < distance;
      if (from_counts && sideAt(metricPlane(source_, from), ray_, distance) <= 0) continue;
      if (sideAt(metricPlane(source_, to), ray_, distance) > 0) continue;
      offer({distance, to});
    }
  }

  OracleHit hitAt(const Event& event, bool assumed) const {
    const Pinhole& p = source_.pinhole();
    const bool at_infinity = event.distance == kInfinity;
    const glm::dvec3 point =
        at_infinity ? ray_.direction : ray_.origin_m + event.distance * ray_.direction;
    return {p.principal_px.x - p.focal_px.x * point.x / point.z,
            p.principal_px.y + p.focal_px.y * point.y / point.z,
            at_infinity ? 0 : -1 / point.z,
            assumed,
            event.facet,
            {}};
  }

  const OracleSource& source_;
  const Ray& ray_;
  std::optional<Event> first_;
  double last_ = 0;  // a place in the last column
  // Where the ray first is behind each layer, having been behind those before it.
  std::vector<double> behind_from_;
  bool behind_at_end_ = false;
};

}  // namespace

OracleAnswer traceAllFacets(const OracleSource& source, const Ray& ray) {
  return AllFacets(source, ray).run();
}

}  // namespace viewloom::oracle
