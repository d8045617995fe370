// SPDX-License-Identifier: Apache-2.0
// A focal plane that follows what a stream shows.
#pragma once

#include <cstdint>
#include <optional>

#include "display/atlas_layout.h"

namespace viewloom {

// A plane that has moved by less than this stays: px of disparity between neighbouring views. What
// fuses may be a hundred times as much, and the outermost of 48 views move by 1.2 px from the
// middle.
inline constexpr double kFocusStep_px = 0.05;

// Exponential smoothing of 1/Z, in which disparity is linear: after time_constant_s it has gone 63
// % of its way. Thread-safety: none.
class FocusFollower {
 public:
  // Goes on to a frame at time_ns, of any clock that does not go back; one that does stands still.
  // It begins, with the first, where `layout` has the plane. The result is the focal distance that
  // the display is to be laid out for; empty while `layout` serves.
  std::optional<double> follow(const AtlasLayout& layout, double suggested_focal_distance_m,
                               double time_constant_s, int64_t time_ns);

 private:
  std::optional<int64_t> time_ns_;  // of the last frame
  double inv_z_ = 0;                // 1/m
};

}  // namespace viewloom
