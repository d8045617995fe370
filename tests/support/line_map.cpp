// SPDX-License-Identifier: Apache-2.0
#include "support/line_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viewloom::test {
namespace {

// The visible part of a line, and how near it is.
struct SeenLine {
  std::vector<double> place;
  std::vector<double> disparity_px;

  explicit SeenLine(size_t count)
      : place(count, std::numeric_limits<double>::quiet_NaN()),
        disparity_px(count, -std::numeric_limits<double>::infinity()) {}

  // A straight piece from one place, seen at x, to another.
  struct End {
    double x = 0;
    double place = 0;
    double disparity_px = 0;
  };
  void draw(const End& a, const End& b) {
    const auto last = static_cast<double>(place.size());
    const auto first_px = static_cast<size_t>(std::clamp(std::ceil(std::min(a.x, b.x)), 0.0, last));
    const auto end_px = static_cast<size_t>(std::clamp(std::ceil(std::max(a.x, b.x)), 0.0, last));
    for (size_t px = first_px; px < end_px; ++px) {
      const double t = (static_cast<double>(px) - a.x) / (b.x - a.x);
      const double nearness = std::lerp(a.disparity_px, b.disparity_px, t);
      if (nearness <= disparity_px[px]) continue;
      disparity_px[px] = nearness;
      place[px] = std::lerp(a.place, b.place, t);
    }
  }
};

}  // namespace

std::vector<double> mapLine(std::span<const float> disparity_px, const LineMove& move) {
  SeenLine seen(disparity_px.size());
  const auto endAt = [&](size_t i) {
    const double d = disparity_px[i];
    const auto place = static_cast<double>(i);
    return SeenLine::End{.x = place - move.steps * d, .place = place, .disparity_px = d};
  };
  bool is_connected = false;
  for (size_t i = 0; i < disparity_px.size(); ++i) {
    const SeenLine::End here = endAt(i);
    SeenLine::End beside = here;
    beside.x = here.x - 0.5;
    if (!is_connected) seen.draw(beside, here);
    is_connected = i + 1 < disparity_px.size() &&
                   std::abs(double{disparity_px[i + 1]} - here.disparity_px) <= move.cut_px;
    beside.x = here.x + 0.5;
    if (is_connected)
      seen.draw(here, endAt(i + 1));
    else
      seen.draw(here, beside);
  }
  return seen.place;
}

double valueAt(std::span<const float> line, double place) {
  const auto before = static_cast<size_t>(place);
  if (before + 1 >= line.size()) return line[before];
  return std::lerp(double{line[before]}, double{line[before + 1]},
                   place - static_cast<double>(before));
}

}  // namespace viewloom::test
