// SPDX-License-Identifier: Apache-2.0
#include "oracle/brute_force.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "oracle/metric_planes.h"

namespace viewloom::oracle {
namespace {

// Share of the seen part: far above rounding, far below the way through a column.
constexpr double kJustBefore = 1e-9;

// Surface that is assumed to go on behind a silhouette that the ray passed.
struct FarSide {
  double inv_z = -1;  // none
  double passed_at = 0;

  bool exists() const { return inv_z >= 0; }
};

struct Event {
  double distance = kInfinity;
  FacetAt facet;
};

class AllFacets {
 public:
  AllFacets(const OracleSource& source, const Ray& ray)
      : source_(source),
        ray_(ray),
        behind_from_(size_t(source.layerCount()), kInfinity),
        over_from_(size_t(source.layerCount()), kInfinity) {}

  OracleAnswer run() {
    const Stretch seen =
        insideOf(pyramidOver(source_.pinhole(), 0, 0, source_.width(), source_.height()), ray_);
    OracleAnswer answer;
    if (seen.empty()) return answer;
    last_ = seen.end == kInfinity ? kInfinity : seen.end - kJustBefore * (seen.end - seen.begin);
    visitFacets([&](const FacetAt& at) { considerBegin(at); });
    findWhatIsOver();
    visitFacets([&](const FacetAt& at) { considerFacet(at); });
    visitFacets([&](const FacetAt& at) {
      considerEdges(at, {-1, at.column + 1, at.row});
      considerEdges(at, {-1, at.column, at.row + 1});
    });
    if (first_) {
      const bool assumed = behind_from_[0] < first_->distance;
      answer.ray_class = assumed ? RayClass::kHitAssumed : RayClass::kHit;
      answer.hits.push_back(hitAt(*first_, assumed));
    } else if (behind_at_end_ || isOver({0, 0, 0}, kInfinity)) {
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

  // Columns on the ray, in its order.
  std::vector<FacetAt> columnsMet() const {
    std::vector<FacetAt> columns;
    for (int row = 0; row < source_.height(); ++row) {
      for (int column = 0; column < source_.width(); ++column) {
        if (!inColumn({0, column, row}).empty()) columns.push_back({0, column, row});
      }
    }
    std::sort(columns.begin(), columns.end(), [this](const FacetAt& a, const FacetAt& b) {
      return inColumn(a).begin < inColumn(b).begin;
    });
    return columns;
  }

  double invZAt(double distance) const {
    if (distance == kInfinity) return 0;
    return -1 / (ray_.origin_m + distance * ray_.direction).z;
  }

  // Where the ray is as far back as the far side of a silhouette that it is still behind.
  void findWhatIsOver() {
    const std::vector<FacetAt> columns = columnsMet();
    for (int layer = 0; layer < source_.layerCount(); ++layer) {
      FarSide far;
      for (size_t i = 0; i < columns.size(); ++i) {
        const FacetAt at{layer, columns[i].column, columns[i].row};
        const Stretch inside = inColumn(at);
        if (i > 0) {
          const FacetAt before{layer, columns[i - 1].column, columns[i - 1].row};
          far = farSideBehind(before, at, inside.begin, far);
        }
        if (!far.exists()) continue;
        const double out = comesOut(at, inside);
        const double over = (-1 / far.inv_z - ray_.origin_m.z) / ray_.direction.z;
        if (invZAt(inside.end) <= far.inv_z && over <= out) {
          const double met_at = std::max(over, inside.begin);
          if (source_.reachesAsFar(far.inv_z, imageAt(far.passed_at), imageAt(met_at))) {
            double& over_from = over_from_[size_t(layer)];
            over_from = std::min(over_from, met_at);
            break;
          }
          far = {};
        }
        if (out < inside.end) far = {};
      }
    }
  }

  // Where a ray that enters a column behind a facet leaves it; the column's end if it does not.
  double comesOut(const FacetAt& at, const Stretch& inside) const {
    if (!source_.exists(at)) return inside.begin;
    const HalfSpace plane = metricPlane(source_, at);
    if (sideAt(plane, ray_, inside.begin) > 0) return inside.begin;
    if (sideAt(plane, ray_, inside.end) <= 0) return inside.end;
    const double per_step = glm::dot(plane.normal, ray_.direction);
    return -(glm::dot(plane.normal, ray_.origin_m) + plane.distance) / per_step;
  }

  // Surface behind a layer once the ray has gone from column to column: as before, or the one that
  // it passes.
  FarSide farSideBehind(const FacetAt& before, const FacetAt& at, double distance,
                        const FarSide& far) const {
    if (!source_.exists(at) || countsFrom(at) > distance) return {};
    if (sideAt(metricPlane(source_, at), ray_, distance) > 0) return {};
    const bool counts_before = countsFrom(before) < distance;
    if (!source_.exists(before)) return {};
    const bool is_over_it = sideAt(metricPlane(source_, before), ray_, distance) > 0;
    if (!is_over_it) return counts_before ? far : FarSide{};
    if (source_.knownBehind(before, at)) return {};
    const glm::dvec2 at_px = imageAt(distance);
    return {source_.planeInvZ(before, at_px.x, at_px.y), distance};
  }

  glm::dvec2 imageAt(double distance) const {
    const bool at_infinity = distance == kInfinity;
    const glm::dvec3 point =
        at_infinity ? ray_.direction : ray_.origin_m + distance * ray_.direction;
    const Pinhole& p = source_.pinhole();
    return {p.principal_px.x - p.focal_px.x * point.x / point.z,
            p.principal_px.y + p.focal_px.y * point.y / point.z};
  }

  // Whether the ray has met the far side behind this layer, or a deeper one, before.
  bool isOver(const FacetAt& at, double distance) const {
    return *std::min_element(over_from_.begin() + at.layer, over_from_.end()) < distance;
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
      if (counts && inside.end == kInfinity && !isOver(at, kInfinity)) offer({kInfinity, at});
      return;
    }
    if (at_begin <= 0) return;
    const double per_step = glm::dot(plane.normal, ray_.direction);
    if (!counts || isOver(at, inside.begin)) return;
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
      if (isOver(to, distance)) continue;
      offer({distance, to});
    }
  }

  OracleHit hitAt(const Event& event, bool assumed) const {
    const glm::dvec2 at_px = imageAt(event.distance);
    return {.x_px = at_px.x,
            .y_px = at_px.y,
            .inv_z = invZAt(event.distance),
            .assumed = assumed,
            .facet = event.facet};
  }

  const OracleSource& source_;
  const Ray& ray_;
  std::optional<Event> first_;
  double last_ = 0;  // a place in the last column
  // Where the ray first is behind each layer, having been behind those before it.
  std::vector<double> behind_from_;
  // Where it meets the far side behind each layer: nothing of that is hit beyond.
  std::vector<double> over_from_;
  bool behind_at_end_ = false;
};

}  // namespace

OracleAnswer traceAllFacets(const OracleSource& source, const Ray& ray) {
  return AllFacets(source, ray).run();
}

}  // namespace viewloom::oracle
