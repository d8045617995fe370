// SPDX-License-Identifier: Apache-2.0
#include "oracle/ray_columns.h"

#include <algorithm>
#include <cmath>

namespace viewloom::oracle {
namespace {

int clampedFloor(double value, int count) {
  return std::clamp(int(std::floor(value)), 0, count - 1);
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

}  // namespace

glm::dvec2 imageOf(const HomogeneousPoint& point) {
  return {point.u / point.z, point.v / point.z};
}

Column columnAt(const OracleSource& source, const HomogeneousPoint& point) {
  const glm::dvec2 at_px = imageOf(point);
  return {clampedFloor(at_px.x, source.width()), clampedFloor(at_px.y, source.height())};
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

}  // namespace viewloom::oracle
