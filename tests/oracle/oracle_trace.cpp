// SPDX-License-Identifier: Apache-2.0
#include "oracle/oracle_trace.h"

#include <algorithm>
#include <cmath>
#include <ostream>

#include <glm/geometric.hpp>

namespace viewloom::oracle {
namespace {

// Where a ray leaves one column for the next.
struct Crossing {
  double s = 0;
  int step_x = 0;
  int step_y = 0;
};

struct Column {
  int column = 0;
  int row = 0;
};

int clampedFloor(double value, int count) {
  return std::clamp(int(std::floor(value)), 0, count - 1);
}

Column columnAt(const OracleSource& source, const HomogeneousPoint& point) {
  return {clampedFloor(point.u / point.z, source.width()),
          clampedFloor(point.v / point.z, source.height())};
}

// Adds the crossings of the lines x = 1, 2, ... (or y) strictly inside the seen part.
void addCrossings(double u_a, double z_a, double u_b, double z_b, int line_count,
                  const SeenPart& seen, Crossing step, std::vector<Crossing>& crossings) {
  // x = u / z changes with the sign of u' z - u z' along the whole ray.
  const int direction = (u_b - u_a) * z_a - u_a * (z_b - z_a) > 0 ? 1 : -1;
  const auto clampedAt = [&](double s) {
    const double at = (u_a + s * (u_b - u_a)) / (z_a + s * (z_b - z_a));
    return std::isnan(at) ? 0.0 : std::clamp(at, 0.0, double(line_count));
  };
  const auto [low, high] = std::minmax({clampedAt(seen.begin), clampedAt(seen.end)});
  const int first = std::max(1, int(low)), last = std::min(line_count - 1, int(high) + 1);
  for (int line = first; line <= last; ++line) {
    const double at_a = u_a - line * z_a;
    const double at_b = u_b - line * z_b;
    if (at_a == at_b) continue;  // never crosses, or runs along the line
    const double s = at_a / (at_a - at_b);
    if (!(s > seen.begin && s < seen.end)) continue;
    crossings.push_back({s, step.step_x * direction, step.step_y * direction});
  }
}

std::vector<Crossing> crossingsOf(const OracleSource& source, const ProjectedRay& ray,
                                  const SeenPart& seen) {
  const auto& [a, b] = ray;
  std::vector<Crossing> crossings;
  addCrossings(a.u, a.z, b.u, b.z, source.width(), seen, {0, 1, 0}, crossings);
  addCrossings(a.v, a.z, b.v, b.z, source.height(), seen, {0, 0, 1}, crossings);
  std::stable_sort(crossings.begin(), crossings.end(),
                   [](const Crossing& one, const Crossing& other) { return one.s < other.s; });
  return crossings;
}

// One ray on its way; hits are collected until the limit.
class Travel {
 public:
  Travel(const OracleSource& source, const ProjectedRay& ray, const SeenPart& seen, size_t limit)
      : source_(source), ray_(ray), seen_(seen), limit_(limit) {}

  OracleAnswer run() {
    const std::vector<Crossing> crossings = crossingsOf(source_, ray_, seen_);
    const double first_end = crossings.empty() ? seen_.end : crossings.front().s;
    Column column = columnAt(source_, ray_.at(0.5 * (seen_.begin + first_end)));
    for (int layer = 0; layer < source_.layerCount(); ++layer) {
      const FacetAt at{layer, column.column, column.row};
      if (isBehind(at, seen_.begin)) {
        been_behind_ = true;
        passBehind(layer);
      }
    }
    double begin = seen_.begin;
    for (const Crossing& crossing : crossings) {
      crossColumn(column, begin, crossing.s, false);
      const Column next{column.column + crossing.step_x, column.row + crossing.step_y};
      crossEdge(column, next, crossing.s);
      column = next;
      begin = crossing.s;
    }
    crossColumn(column, begin, seen_.end, seen_.ends_at_infinity);
    return answer(column);
  }

 private:
  double front(const FacetAt& at, double s) const { return inFront(source_, at, ray_.at(s)); }

  // Layers are in order: whoever has not been behind one is in front of all behind it.
  bool isBehind(const FacetAt& at, double s) const {
    return at.layer <= behind_count_ && source_.exists(at) && front(at, s) <= 0;
  }
  void passBehind(int layer) { behind_count_ = std::max(behind_count_, layer + 1); }

  void crossColumn(const Column& column, double begin, double end, bool ends_at_infinity) {
    std::vector<std::pair<double, OracleHit>> events;
    for (int layer = 0; layer < source_.layerCount(); ++layer) {
      const FacetAt at{layer, column.column, column.row};
      if (!source_.exists(at)) continue;
      const double at_begin = front(at, begin);
      const double at_end = front(at, end);
      // A facet is never below 0: whoever arrives at 1/Z = 0 in front of its plane hits it there,
      // also after having come out from behind it.
      if (at_end > 0 ? !ends_at_infinity : at_begin <= 0) continue;
      const double s = at_end > 0 ? end : begin + (end - begin) * (at_begin / (at_begin - at_end));
      events.emplace_back(s, hitAt(s, at, {}));
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const auto& one, const auto& other) { return one.first < other.first; });
    for (const auto& [s, hit] : events) {
      if (hit.facet.layer > behind_count_) continue;
      record(hit);
      passBehind(hit.facet.layer);
    }
  }

  void crossEdge(const Column& from, const Column& to, double s) {
    bool passes_behind = false;  // from here on: not before what is hit at this very edge
    const int behind_count = behind_count_;  // before the edge
    for (int layer = 0; layer < source_.layerCount(); ++layer) {
      const FacetAt next{layer, to.column, to.row};
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
      if (connected_in_front) {
        record(hitAt(s, next, linked));
      } else if (!connected_behind) {
        passes_behind = true;
      }
      passBehind(layer);
    }
    been_behind_ = been_behind_ || passes_behind;
  }

  OracleHit hitAt(double s, const FacetAt& facet, const FacetAt& linked) const {
    const HomogeneousPoint point = ray_.at(s);
    return {point.u / point.z, point.v / point.z, point.h / point.z, false, facet, linked};
  }

  void record(OracleHit hit) {
    if (answer_.hits.size() >= limit_) return;
    hit.assumed = been_behind_;
    answer_.hits.push_back(hit);
  }

  OracleAnswer answer(const Column& last) {
    if (!answer_.hits.empty()) {
      answer_.ray_class = answer_.hits.front().assumed ? RayClass::kHitAssumed : RayClass::kHit;
      return answer_;
    }
    answer_.ray_class = seen_.ends_at_infinity ? RayClass::kEmpty : RayClass::kOutside;
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
  bool been_behind_ = false;
  int behind_count_ = 0;  // of layers, from the first on, that the ray has been behind
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

HomogeneousPoint ProjectedRay::at(double s) const {
  const auto between = [s](double from, double to) { return (1 - s) * from + s * to; };
  return {between(a.u, b.u), between(a.v, b.v), between(a.z, b.z), between(a.h, b.h)};
}

ProjectedRay projectRay(const Pinhole& pinhole, const Ray& ray) {
  const auto project = [&](const glm::dvec3& p, double h) {
    const double z = -p.z;
    return HomogeneousPoint{pinhole.focal_px.x * p.x + pinhole.principal_px.x * z,
                            -pinhole.focal_px.y * p.y + pinhole.principal_px.y * z, z, h};
  };
  return {project(ray.origin_m, 1), project(glm::normalize(ray.direction), 0)};
}

ProjectedRay movedBy(const ProjectedRay& ray, double x_px, double y_px, double inv_z) {
  const auto move = [&](const HomogeneousPoint& p) {
    return HomogeneousPoint{p.u + x_px * p.z, p.v + y_px * p.z, p.z, p.h + inv_z * p.z};
  };
  return {move(ray.a), move(ray.b)};
}

SeenPart seenPart(const OracleSource& source, const ProjectedRay& ray) {
  const auto& [a, b] = ray;
  SeenPart seen{0, 1, true};
  const auto keepNonNegative = [&seen](double at_a, double at_b, bool is_infinity) {
    if (at_a < 0 && at_b < 0) seen.end = -1;
    if (at_a < 0 && at_b >= 0) seen.begin = std::max(seen.begin, at_a / (at_a - at_b));
    if (at_a >= 0 && at_b < 0) {
      const double s = at_a / (at_a - at_b);
      if (s < seen.end) seen.ends_at_infinity = is_infinity;
      seen.end = std::min(seen.end, s);
    }
  };
  keepNonNegative(a.h, b.h, true);
  keepNonNegative(a.u, b.u, false);
  keepNonNegative(a.v, b.v, false);
  keepNonNegative(source.width() * a.z - a.u, source.width() * b.z - b.u, false);
  keepNonNegative(source.height() * a.z - a.v, source.height() * b.z - b.v, false);
  return seen;
}

double inFront(const OracleSource& source, const FacetAt& at, const HomogeneousPoint& point) {
  const Facet& f = source.facet(at);
  return point.h -
         (double(f.inv_z) * point.z + double(f.slope_x) * (point.u - (at.column + 0.5) * point.z) +
          double(f.slope_y) * (point.v - (at.row + 0.5) * point.z));
}

OracleAnswer traceOracle(const OracleSource& source, const ProjectedRay& ray, size_t hit_limit) {
  const SeenPart seen = seenPart(source, ray);
  if (seen.empty()) return {};
  return Travel(source, ray, seen, hit_limit).run();
}

OracleAnswer traceOracle(const OracleSource& source, const Ray& ray, size_t hit_limit) {
  return traceOracle(source, projectRay(source.pinhole(), ray), hit_limit);
}

}  // namespace viewloom::oracle
