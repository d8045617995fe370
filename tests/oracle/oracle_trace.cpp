// SPDX-License-Identifier: Apache-2.0
#include "oracle/oracle_trace.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>

#include "oracle/ray_columns.h"

namespace viewloom::oracle {
namespace {

// One ray on its way; hits are collected until the limit.
class Travel {
 public:
  Travel(const OracleSource& source, const ProjectedRay& ray, const SeenPart& seen, size_t limit,
         std::optional<int> surface_layer = {})
      : source_(source),
        ray_(ray),
        seen_(seen),
        limit_(limit),
        surface_layer_(surface_layer),
        behind_(size_t(source.layerCount())) {}

  OracleAnswer run() {
    const std::vector<Crossing> crossings = crossingsOf(source_, ray_, seen_);
    const double first_end = crossings.empty() ? seen_.end : crossings.front().s;
    Column column = columnAt(source_, ray_.at(0.5 * (seen_.begin + first_end)));
    for (int layer = 0; layer < source_.layerCount(); ++layer) {
      if (beginsBehind({layer, column.column, column.row})) {
        noteBehind(seen_.begin);
        passBehind(layer);
      }
    }
    double begin = seen_.begin;
    for (const Crossing& crossing : crossings) {
      crossColumn(column, begin, crossing.s, false);
      is_first_column_ = false;
      const Column next{column.column + crossing.step_x, column.row + crossing.step_y};
      crossEdge(column, next, crossing.s);
      column = next;
      begin = crossing.s;
    }
    crossColumn(column, begin, seen_.end, seen_.ends_at_infinity);
    return answer(column);
  }

 private:
  // State of a layer that the ray is behind.
  struct Behind {
    // How far back the far side of the silhouette lies that it passed behind; none: nothing there.
    std::optional<double> far_inv_z;
    glm::dvec2 passed_px{0.0};  // where it passed it, in the image
    // The ray has met that far side: nothing of this layer and those before it is hit any more.
    bool is_over = false;
  };

  double front(const FacetAt& at, double s) const { return inFront(source_, at, ray_.at(s)); }
  bool isOver(int layer) const {
    return std::any_of(behind_.begin() + layer, behind_.end(),
                       [](const Behind& behind) { return behind.is_over; });
  }

  // Layers are in order: whoever has not been behind one is in front of all behind it.
  bool isBehind(const FacetAt& at, double s) const {
    return at.layer <= behind_count_ && source_.exists(at) && front(at, s) <= 0;
  }
  bool beginsBehind(const FacetAt& at) const {
    return surface_layer_ ? at.layer < *surface_layer_ : isBehind(at, seen_.begin);
  }
  // In the column where it begins, it does not come out from behind what it begins behind.
  bool staysBehind(int layer) const {
    return is_first_column_ && surface_layer_ && layer < *surface_layer_;
  }
  void noteBehind(double s) {
    been_behind_ = true;
    if (answer_.hits.empty()) answer_.passed_s = std::min(answer_.passed_s, s);
  }
  void passBehind(int layer) { behind_count_ = std::max(behind_count_, layer + 1); }

  void crossColumn(const Column& column, double begin, double end, bool ends_at_infinity) {
    std::vector<std::pair<double, OracleHit>> events;
    for (int layer = 0; layer < source_.layerCount(); ++layer) {
      const FacetAt at{layer, column.column, column.row};
      goOnBehind(at, begin, end);
      if (!source_.exists(at)) continue;
      const double at_begin =
          staysBehind(layer) ? std::min(front(at, begin), 0.0) : front(at, begin);
      const double at_end = front(at, end);
      const double crosses_s = begin + (end - begin) * (at_begin / (at_begin - at_end));
      const bool comes_out = at_begin <= 0 && at_end > 0;
      // A facet is never below 0: whoever arrives at 1/Z = 0 in front of its plane hits it there,
      // also after having come out from behind it.
      if (surface_layer_ && comes_out && !ends_at_infinity && !staysBehind(layer)) {
        events.emplace_back(crosses_s, backAt(crosses_s, at));
      }
      if (at_end > 0 ? !ends_at_infinity : at_begin <= 0) continue;
      const double s = at_end > 0 ? end : crosses_s;
      events.emplace_back(s, hitAt(s, at, {}));
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const auto& one, const auto& other) { return one.first < other.first; });
    for (const auto& [s, hit] : events) {
      if (hit.facet.layer > behind_count_ || isOver(hit.facet.layer)) continue;
      record(hit);
      passBehind(hit.facet.layer);
    }
  }

  // Through a column, while behind a layer: out of it, or to the far side before that.
  void goOnBehind(const FacetAt& at, double begin, double end) {
    Behind& behind = behind_[size_t(at.layer)];
    if (!behind.far_inv_z || behind.is_over) return;
    const double at_begin = source_.exists(at) ? front(at, begin) : 1;
    const double at_end = source_.exists(at) ? front(at, end) : 1;
    const auto aboveFar = [&](double s) {
      const HomogeneousPoint point = ray_.at(s);
      return point.h - *behind.far_inv_z * point.z;
    };
    const double far_begin = aboveFar(begin);
    const double far_end = aboveFar(end);
    if (at_begin <= 0 && far_end <= 0) {
      const double out = at_end > 0 ? at_begin / (at_begin - at_end) : 1;
      const double met = far_begin <= 0 ? 0 : far_begin / (far_begin - far_end);
      if (met <= out) meetFarSide(behind, begin + met * (end - begin));
    }
    if (at_begin > 0 || at_end > 0) behind.far_inv_z.reset();
  }

  // Where the ray is as far back as the far side; that either goes on so far, or ended before.
  void meetFarSide(Behind& behind, double s) const {
    const glm::dvec2 met_px = imageOf(ray_.at(s));
    behind.is_over = source_.reachesAsFar(*behind.far_inv_z, behind.passed_px, met_px);
    if (!behind.is_over) behind.far_inv_z.reset();
  }

  // Passes behind the silhouette of a layer: what it was in front of before goes on behind it.
  void passSilhouette(const FacetAt& before, const Column& to, int behind_count, double s) {
    Behind& behind = behind_[size_t(before.layer)];
    const bool is_over_it = source_.exists(before) && front(before, s) > 0;
    const bool was_behind = source_.exists(before) && !is_over_it && before.layer <= behind_count;
    if (was_behind) return;
    behind.far_inv_z.reset();
    if (!is_over_it) return;
    const HomogeneousPoint point = ray_.at(s);
    if (source_.knownBehind(before, {before.layer, to.column, to.row})) return;
    behind.passed_px = imageOf(point);
    behind.far_inv_z = source_.planeInvZ(before, behind.passed_px.x, behind.passed_px.y);
  }

  // From behind one facet of a surface to before the next one.
  void comeOutBetween(const FacetAt& from, const FacetAt& to, double s) {
    const bool comes_out = surface_layer_ && isBehind(from, s) && source_.linked(from, to) &&
                           front(to, s) > 0 && !isOver(from.layer);
    if (comes_out) record(backAt(s, to));
  }

  void crossEdge(const Column& from, const Column& to, double s) {
    bool passes_behind = false;  // from here on: not before what is hit at this very edge
    const int behind_count = behind_count_;  // before the edge
    for (int layer = 0; layer < source_.layerCount(); ++layer) {
      const FacetAt next{layer, to.column, to.row};
      comeOutBetween({layer, from.column, from.row}, next, s);
      if (!isBehind(next, s)) continue;
      bool connected_behind = false;
      bool connected_in_front = false;
      FacetAt linked;
      for (int other = 0; other < source_.layerCount(); ++other) {
        const FacetAt previous{other, from.column, from.row};
        if (!source_.linked(previous, next)) continue;
        linked = previous;
        const bool in_front = other > behind_count || front(previous, s) > 0;
        (in_front ? connected_in_front : connected_behind) = true;
      }
      if (connected_in_front && !isOver(layer)) record(hitAt(s, next, linked));
      if (!connected_in_front && !connected_behind) {
        passes_behind = true;
        passSilhouette({layer, from.column, from.row}, to, behind_count, s);
      }
      passBehind(layer);
    }
    if (passes_behind) noteBehind(s);
  }

  OracleHit hitAt(double s, const FacetAt& facet, const FacetAt& linked) const {
    const HomogeneousPoint point = ray_.at(s);
    return {
        point.u / point.z, point.v / point.z, point.h / point.z, s, false, false, facet, linked};
  }

  OracleHit backAt(double s, const FacetAt& facet) const {
    OracleHit hit = hitAt(s, facet, {});
    hit.is_back = true;
    return hit;
  }

  void record(OracleHit hit) {
    if (answer_.hits.size() >= limit_) return;
    hit.assumed = been_behind_;
    answer_.hits.push_back(hit);
    // Whoever looks for more begins anew, behind what it has hit.
    std::fill(behind_.begin(), behind_.end(), Behind{});
  }

  OracleAnswer answer(const Column& last) {
    if (!answer_.hits.empty()) {
      answer_.ray_class = answer_.hits.front().assumed ? RayClass::kHitAssumed : RayClass::kHit;
      return answer_;
    }
    answer_.ray_class = seen_.ends_at_infinity ? RayClass::kEmpty : RayClass::kOutside;
    if (isOver(0)) answer_.ray_class = RayClass::kHidden;
    for (int layer = 0; layer < source_.layerCount(); ++layer) {
      const FacetAt at{layer, last.column, last.row};
      if (isBehind(at, seen_.end)) answer_.ray_class = RayClass::kHidden;
    }
    return answer_;
  }

  const OracleSource& source_;
  const ProjectedRay& ray_;
  const SeenPart seen_;
  const size_t limit_;
  const std::optional<int> surface_layer_;  // that it goes on from
  bool is_first_column_ = true;
  bool been_behind_ = false;
  int behind_count_ = 0;        // of layers, from the first on, that the ray has been behind
  std::vector<Behind> behind_;  // by layer
  OracleAnswer answer_;
};

}  // namespace

const char* nameOf(RayClass ray_class) {
  switch (ray_class) {
    case RayClass::kHit:
      return "hit";
    case RayClass::kHitAssumed:
      return "hit, assumed";
    case RayClass::kHidden:
      return "hidden";
    case RayClass::kOutside:
      return "outside";
    case RayClass::kEmpty:
      return "empty";
  }
  return "?";
}

std::ostream& operator<<(std::ostream& out, RayClass ray_class) {
  return out << nameOf(ray_class);
}

OracleAnswer traceOracle(const OracleSource& source, const ProjectedRay& ray, size_t hit_limit) {
  const SeenPart seen = seenPart(source, ray);
  if (seen.empty()) return {};
  return Travel(source, ray, seen, hit_limit).run();
}

OracleAnswer traceOracle(const OracleSource& source, const ProjectedRay& ray, const SeenPart& part,
                         size_t hit_limit) {
  return Travel(source, ray, part, hit_limit).run();
}

OracleAnswer traceOracle(const OracleSource& source, const Ray& ray, size_t hit_limit) {
  return traceOracle(source, projectRay(source.pinhole(), ray), hit_limit);
}

OracleAnswer traceFromSurface(const OracleSource& source, const ProjectedRay& ray,
                              int surface_layer) {
  const SeenPart seen = seenPart(source, ray);
  if (seen.empty()) return {};
  return Travel(source, ray, seen, 1, surface_layer).run();
}

}  // namespace viewloom::oracle
