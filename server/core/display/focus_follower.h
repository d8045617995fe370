// SPDX-License-Identifier: Apache-2.0
// Moves the focal plane with the content of a stream.
#pragma once

#include <cstdint>
#include <optional>

#include "display/atlas_layout.h"

namespace viewloom {

// Smallest movement of the plane, px of disparity between neighbouring views. A hundred times as
// much still fuses. The outermost of 48 views move by 1.2 px from the middle.
inline constexpr double kFocusStep_px = 0.05;

// Smooths 1/Z exponentially, because disparity is linear in it. After time_constant_s it has gone
// 63 % of the way. Thread-safety: none.
class FocusFollower {
 public:
  // Advances to a frame at time_ns of any clock. If the clock goes back, the plane stays. The first
  // frame begins where `layout` has the plane. Returns the focal distance for a new layout; empty
  // while `layout` is good enough.
  std::optional<double> follow(const AtlasLayout& layout, double suggested_focal_distance_m,
                               double time_constant_s, int64_t time_ns);

 private:
  std::optional<int64_t> time_ns_;  // time of the last frame
  double inv_z_ = 0;                // 1/m
};

}  // namespace viewloom
