// SPDX-License-Identifier: Apache-2.0
#include "scoring/separable_filter.h"

#include <algorithm>

#include "base/check.h"

namespace viewloom {
namespace {

// The sample i of `count`, or the one at the edge that is nearer.
size_t held(int64_t i, uint32_t count) {
  return static_cast<size_t>(std::clamp<int64_t>(i, 0, int64_t{count} - 1));
}

void filterRow(std::span<const float> row, std::span<const float> weights, std::span<float> sums) {
  const auto width = static_cast<uint32_t>(row.size());
  const auto radius = static_cast<int64_t>(weights.size() / 2);
  for (int64_t x = 0; x < width; ++x) {
    float sum = 0;
    if (x >= radius && x + radius < width) {
      const float* const from = &row[static_cast<size_t>(x - radius)];
      for (size_t k = 0; k < weights.size(); ++k) sum += weights[k] * from[k];
    } else {
      for (size_t k = 0; k < weights.size(); ++k) {
        sum += weights[k] * row[held(x + int64_t(k) - radius, width)];
      }
    }
    sums[static_cast<size_t>(x)] = sum;
  }
}

}  // namespace

std::vector<float> filtered(std::span<const float> plane, SizePx size_px,
                            std::span<const float> across, std::span<const float> down) {
  VIEWLOOM_CHECK(plane.size() == size_px.area());
  VIEWLOOM_CHECK(across.size() % 2 == 1 && down.size() % 2 == 1);
  const size_t width = size_px.width;
  std::vector<float> rows(plane.size());
  for (size_t begin = 0; begin < plane.size(); begin += width) {
    filterRow(plane.subspan(begin, width), across, std::span(rows).subspan(begin, width));
  }
  // Whole rows at a time: columns would be read across the grain of the memory.
  std::vector<float> sums(plane.size(), 0.0F);
  const auto radius = static_cast<int64_t>(down.size() / 2);
  for (int64_t y = 0; y < size_px.height; ++y) {
    float* const to = &sums[static_cast<size_t>(y) * width];
    for (size_t k = 0; k < down.size(); ++k) {
      const float* const from = &rows[held(y + int64_t(k) - radius, size_px.height) * width];
      for (size_t x = 0; x < width; ++x) to[x] += down[k] * from[x];
    }
  }
  return sums;
}

}  // namespace viewloom
