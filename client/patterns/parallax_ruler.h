// SPDX-License-Identifier: Apache-2.0
// Rulers before and behind the focal plane, each above one on the plane itself: how far the upper
// moves along the lower from view to view is its disparity.
#pragma once

#include <vector>

#include "patterns/canvas.h"
#include "patterns/pattern.h"

namespace viewloom::patterns {

// A ruler with marks on a plane that faces the source, which slides along another beside it.
struct RulerRow {
  double inv_z = 0;         // 1/m
  double disparity_px = 0;  // px of a view, from view to view on average; before the plane > 0
  PxBox sliding;            // the ruler, where the source sees it
  double focal_ruler_top_px = 0;  // of that on the focal plane
};

struct RulerPlaces {
  double focal_px = 0;
  double mark_px = 0;          // between marks, which are 10 px of a view apart
  std::vector<RulerRow> rows;  // from the nearest, at the top, to the farthest
};

RulerPlaces rulerPlaces(const PatternOptions& options);

absl::StatusOr<Pattern> drawParallaxRuler(const PatternOptions& options);

}  // namespace viewloom::patterns
