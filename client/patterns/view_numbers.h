// SPDX-License-Identifier: Apache-2.0
// A parallax barrier: through a window each view sees a number of its own on a strip far behind.
#pragma once

#include <array>

#include "patterns/canvas.h"
#include "patterns/pattern.h"

namespace viewloom::patterns {

// The plate with the window stands on the focal plane, the strip at a part of its 1/Z.
inline constexpr double kStripDepthShare = 0.5;
// Narrower numbers cannot be read.
inline constexpr double kNumberMin_px = 16;

// Where things stand in the source's image.
struct NumberPlaces {
  double focal_px = 0;
  // From its own eye, at tangent t of the focal distance, a view sees through x of the plate what
  // the source has at x - reach_px t on the strip.
  double reach_px = 0;
  PxBox window;  // as wide as a number

  double middleOnStrip(double eye_tangent) const;
};

// INVALID_ARGUMENT where so many numbers do not fit beside each other.
absl::StatusOr<NumberPlaces> numberPlaces(const PatternOptions& options);

// Below its digits each number stands as black and white blocks, so that programs can read it: in
// two columns, from above, a row of white and black; five rows of the number's ten bits, the
// highest first; the number of white bits is odd (white) or even (black), and the opposite.
inline constexpr uint32_t kCodeColumns = 2;
inline constexpr uint32_t kCodeRows = 7;
// A block of the code below the number that fills the window.
PxBox codeBlock(const PxBox& window, uint32_t row, uint32_t column);
// Whether they are white, row by row.
std::array<bool, size_t{kCodeRows} * kCodeColumns> codeOf(uint32_t number);

absl::StatusOr<Pattern> drawViewNumbers(const PatternOptions& options);

}  // namespace viewloom::patterns
