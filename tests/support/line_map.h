// SPDX-License-Identifier: Apache-2.0
// View that stands beside its source: pixels move along lines of the image, each by a multiple of
// its disparity, and the nearest one hides the others. The forward map of one line.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "frame/size.h"

namespace viewloom::test {

struct LineMove {
  // Sample i, in the middle of pixel i, comes to i - steps * disparity_px[i].
  double steps = 0;
  // Neighbours whose disparities differ by more are not connected; negative = none are.
  double cut_px = 0;
};

// For each pixel the place on the line that is seen at its middle: 2.25 is a quarter of the way
// from sample 2 to sample 3. NaN where nothing is seen. Between connected neighbours lies a
// straight piece; a sample without one reaches half a pixel to that side, as far away as it is.
// disparity_px: larger is nearer.
std::vector<double> mapLine(std::span<const float> disparity_px, const LineMove& move);

// The value at a place on a line, between two samples in proportion.
double valueAt(std::span<const float> line, double place);

// The pixels of an image as lines in the direction of (columns, rows), of which one is 0 or both
// are equal in size: visit(std::span<const size_t> indices), in the order of x, else of y.
template <typename Visit>
void forEachLine(SizePx size_px, int columns, int rows, Visit visit) {
  const int step_x = columns != 0 ? 1 : 0;
  const int step_y = columns == 0 ? 1 : rows == 0 ? 0 : (columns > 0) == (rows > 0) ? 1 : -1;
  const auto width = static_cast<int>(size_px.width);
  const auto height = static_cast<int>(size_px.height);
  std::vector<size_t> indices;
  const auto isInside = [&](int x, int y) { return x >= 0 && y >= 0 && x < width && y < height; };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (isInside(x - step_x, y - step_y)) continue;  // its line began before it
      indices.clear();
      for (int u = x, v = y; isInside(u, v); u += step_x, v += step_y) {
        indices.push_back(static_cast<size_t>(v) * size_px.width + static_cast<size_t>(u));
      }
      visit(std::span<const size_t>(indices));
    }
  }
}

}  // namespace viewloom::test
