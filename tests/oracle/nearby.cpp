// SPDX-License-Identifier: Apache-2.0
#include "oracle/nearby.h"

#include <cmath>
#include <numbers>

namespace viewloom::oracle {

std::vector<glm::dvec2> movesWithin(double output_px) {
  constexpr double kShares[] = {1, 0.5, 0.25, 0.125};
  constexpr double kOctagonRadius = 1.0824;  // 1 / cos(pi / 8)
  std::vector<glm::dvec2> moves_px;
  for (const double share : kShares) {
    const double radius_px = share * kOctagonRadius * output_px;
    for (int eighth = 0; eighth < 8; ++eighth) {
      const double angle = eighth * std::numbers::pi / 4;
      moves_px.emplace_back(radius_px * std::cos(angle), radius_px * std::sin(angle));
    }
  }
  return moves_px;
}

}  // namespace viewloom::oracle
