// SPDX-License-Identifier: Apache-2.0
// Depth formats of the kinds of input, completed and overridden by what the user says.
#pragma once

#include "base/status.h"
#include "inputs/input_settings.h"

namespace viewloom::inputs {

// The format, with the values that the settings give.
v1::DepthFormat withSettings(v1::DepthFormat format, const InputSettings& settings);

// Bounds of samples.
struct SampleRange {
  double black = 0;
  double white = 1;
};

// The distances of the nearest and the farthest code.
struct NearAndFar {
  double near_m = 0;
  double far_m = 0;
};
// Fills in missing bounds for a display. Depth of unknown scale suits any distances: on displays
// whose cone turns about the focal plane, only their ratio is visible. 1/Z from 0.5 to 1.5 1/m puts
// the focal plane, which lies at the mean, at 1 m. It keeps the disparity between views of 48 views
// of 420 px over 35 degrees within the 5 px that fuse (server/display/depth_budget.h): 420 px x
// tan(17.5) / tan(15.3) / 47 x 0.5 = 5.2 px, at the ends.
NearAndFar nearAndFar(const InputSettings& settings);
// Whether nearAndFar chooses any.
bool choosesDistances(const InputSettings& settings);

// From black, the farthest, to white, the nearest (is_black_near: the other way), linear in 1/Z,
// or, when the settings say planar, in Z. INVALID_ARGUMENT without two different distances; the far
// one may be infinite but for planar.
absl::StatusOr<v1::DepthFormat> normalisedFormat(const InputSettings& settings,
                                                 const SampleRange& range);

// 2D-plus-Depth, white before the screen; codes 0..255, or as many more as `range` has:
//   1/Z = (1 + factor / 64 * (code - screen_code) / 255) / screen
// So, at a factor of 64 (100 %), white and black differ by the screen's own 1/Z. INVALID_ARGUMENT
// when black would lie behind infinity.
absl::StatusOr<v1::DepthFormat> twoDPlusZFormat(const InputSettings& settings,
                                                const SampleRange& range);

}  // namespace viewloom::inputs
