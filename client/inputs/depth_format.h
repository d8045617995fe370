// SPDX-License-Identifier: Apache-2.0
// Depth formats of the kinds of input, completed and overridden by what the user says.
#pragma once

#include "base/status.h"
#include "inputs/input_settings.h"

namespace viewloom::inputs {

// What is given in the settings replaces what `format` has.
v1::DepthFormat withSettings(v1::DepthFormat format, const InputSettings& settings);

// What samples lie between.
struct SampleRange {
  double black = 0;
  double white = 1;
};

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
