// SPDX-License-Identifier: Apache-2.0
// Places that judges look at around a ray, and the range of the answers there.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include <glm/vec2.hpp>

namespace viewloom::oracle {

// Ways to move a picture within `output_px`: around circles of shares of it, an octave apart, since
// what is met changes by scales. Eight directions stand for a circle, so far out that their octagon
// encloses it.
std::vector<glm::dvec2> movesWithin(double output_px);

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool holds(double value, double slack) const {
    return value >= low - slack && value <= high + slack;
  }
};

}  // namespace viewloom::oracle
