// SPDX-License-Identifier: Apache-2.0
// The display that a pattern is drawn for: where the eyes of its views stand.
#pragma once

#include <cstdint>
#include <numbers>

#include "frame/camera.h"

namespace viewloom::patterns {

// Eyes as viewloomd places those of quilts by default: with t = (i + 0.5) / N - 0.5, view i of N
// stands at D tan(cone t) beside the middle, view 0 leftmost.
struct DisplayViews {
  uint32_t count = 48;
  double cone_rad = 40 * std::numbers::pi / 180;
  SizePx size_px{420, 560};  // of a view

  double angle_rad(uint32_t view) const;
  // x of its eye, as a share of the focal distance.
  double eyeTangent(uint32_t view) const;
  double outermostTangent() const { return eyeTangent(count - 1); }
  // From eye to eye, on average.
  double pitchTangent() const { return 2 * outermostTangent() / (count - 1); }
  // The focal length of a view, px of its width: views show what such a source does of the focal
  // plane, cropped around its middle to their aspect.
  double focalPx(double source_focal_px, SizePx source_px) const;
};

}  // namespace viewloom::patterns
