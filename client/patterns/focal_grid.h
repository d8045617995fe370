// SPDX-License-Identifier: Apache-2.0
// A grid on the focal plane, which stands still from view to view, and slanted planes through it.
#pragma once

#include "patterns/canvas.h"
#include "patterns/pattern.h"

namespace viewloom::patterns {

struct GridPlaces {
  double focal_px = 0;
  double line_distance_px = 0;  // of the source, as all of these
  // Each passes through the focal plane in its middle; the half where 1/Z is less is seen through a
  // window of the grid. 1/Z grows by inv_z_per_px to the left in the first, downwards in the
  // second.
  PxBox turned;
  PxBox tilted;
  double inv_z_per_px = 0;
};

GridPlaces gridPlaces(const PatternOptions& options);

absl::StatusOr<Pattern> drawFocalGrid(const PatternOptions& options);

}  // namespace viewloom::patterns
