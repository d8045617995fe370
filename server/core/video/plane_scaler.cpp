// SPDX-License-Identifier: Apache-2.0
#include "video/plane_scaler.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace viewloom {
namespace {

constexpr double kReach = 2;  // of the filter, in samples at a ratio of 1

// Catmull-Rom (Mitchell and Netravali 1988, with B = 0 and C = 1/2).
double cubic(double x) {
  x = std::abs(x);
  if (x < 1) return (1.5 * x - 2.5) * x * x + 1;
  if (x < kReach) return ((-0.5 * x + 2.5) * x - 4) * x + 2;
  return 0;
}

uint8_t codeOf(float value) {
  return uint8_t(std::clamp(value, 0.0F, 255.0F) + 0.5F);
}

}  // namespace

LineWeights::LineWeights(uint32_t from_count, uint32_t to_count, double ratio)
    : tap_count_(std::min(uint32_t(std::ceil(2 * kReach * ratio)) + 1, from_count)),
      firsts_(to_count),
      weights_(size_t{to_count} * tap_count_) {
  VIEWLOOM_CHECK(ratio >= 1 && from_count > 0);
  for (uint32_t i = 0; i < to_count; ++i) {
    const double center = (i + 0.5) * ratio - 0.5;
    const auto lowest = int64_t(std::ceil(center - kReach * ratio));
    const int64_t first_max = int64_t{from_count} - tap_count_;
    firsts_[i] = uint32_t(std::clamp<int64_t>(lowest, 0, first_max));
    float* const weights = &weights_[size_t{i} * tap_count_];
    const auto highest = int64_t(std::floor(center + kReach * ratio));
    double sum = 0;
    for (int64_t at = lowest; at <= highest; ++at) sum += cubic((double(at) - center) / ratio);
    for (int64_t at = lowest; at <= highest; ++at) {
      const int64_t taken = std::clamp<int64_t>(at, 0, int64_t{from_count} - 1);
      const int64_t tap = std::clamp<int64_t>(taken - firsts_[i], 0, int64_t{tap_count_} - 1);
      weights[tap] += float(cubic((double(at) - center) / ratio) / sum);
    }
  }
}

PlaneScaler::PlaneScaler(SizePx from_px, SizePx to_px, double column_ratio, double row_ratio)
    : columns_(from_px.width, to_px.width, column_ratio),
      rows_(from_px.height, to_px.height, row_ratio),
      between_(size_t{from_px.height} * to_px.width),
      sums_(to_px.width) {}

void PlaneScaler::scale(const uint8_t* from, size_t from_stride_bytes, uint8_t* to,
                        size_t to_stride_bytes) {
  const size_t width = columns_.size();
  const size_t from_height = between_.size() / width;
  for (size_t y = 0; y < from_height; ++y) {
    const uint8_t* const from_row = from + y * from_stride_bytes;
    float* const between_row = &between_[y * width];
    for (uint32_t x = 0; x < width; ++x) {
      const uint8_t* const taps = from_row + columns_.first(x);
      const float* const weights = columns_.weights(x);
      float sum = 0;
      for (uint32_t tap = 0; tap < columns_.tapCount(); ++tap) sum += weights[tap] * taps[tap];
      between_row[x] = sum;
    }
  }
  for (uint32_t y = 0; y < rows_.size(); ++y) {
    std::ranges::fill(sums_, 0.0F);
    for (uint32_t tap = 0; tap < rows_.tapCount(); ++tap) {
      const float weight = rows_.weights(y)[tap];
      const float* const row = &between_[(rows_.first(y) + tap) * width];
      for (size_t x = 0; x < width; ++x) sums_[x] += weight * row[x];
    }
    uint8_t* const to_row = to + y * to_stride_bytes;
    for (size_t x = 0; x < width; ++x) to_row[x] = codeOf(sums_[x]);
  }
}

}  // namespace viewloom
