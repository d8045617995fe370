// SPDX-License-Identifier: Apache-2.0
#include "inspect/stored_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

namespace viewloom::inspect {
namespace {

// A number is clearly not 0 from this share of the largest on: codes beside 0 are not, since noise
// and JPEG spread a black sky over them.
constexpr float kClearShare = 1.0F / 16;
// Holes of a scene that show the sky, as windows and arches, are fewer.
constexpr uint64_t kHolesMin = 16;

// Which px of a line lie in a gap of zeros between two clear numbers.
template <typename At, typename Mark>
void markGaps(uint32_t length, const At& at, float clear_from, const Mark& mark) {
  bool is_bounded = false;
  uint32_t first = 0;
  for (uint32_t i = 0; i < length; ++i) {
    if (at(i) == 0) continue;
    const bool is_clear = at(i) >= clear_from;
    if (is_bounded && is_clear && i > first) mark(first, i);
    is_bounded = is_clear;
    first = i + 1;
  }
}

}  // namespace

std::vector<float> storedNumbers(const v1::Plane& plane, const std::vector<uint8_t>& bytes) {
  const bool is_f32 = plane.encoding() == v1::PLANE_ENCODING_DEPTH_F32;
  std::vector<float> stored(bytes.size() / (is_f32 ? 4 : 2));
  if (is_f32) {
    std::memcpy(stored.data(), bytes.data(), 4 * stored.size());
    return stored;
  }
  const bool is_half = plane.encoding() == v1::PLANE_ENCODING_DEPTH_F16;
  for (size_t i = 0; i < stored.size(); ++i) {
    uint16_t word = 0;
    std::memcpy(&word, &bytes[2 * i], sizeof(word));
    stored[i] = is_half ? glm::unpackHalf1x16(word) : float(word);
  }
  return stored;
}

bool ZeroPattern::isOfPoints() const {
  return zero_count > 0 && 2 * lone_count > clear_count;
}

bool ZeroPattern::isScattered() const {
  if (zero_count == 0) return false;
  return isOfPoints() || (2 * enclosed_count > zero_count && hole_count >= kHolesMin);
}

ZeroPattern zeroPattern(std::span<const float> stored, uint32_t width_px, uint32_t height_px) {
  ZeroPattern pattern;
  float largest = 0;
  for (const float number : stored) {
    if (number == 0) ++pattern.zero_count;
    if (std::isfinite(number)) largest = std::max(largest, number);
  }
  if (pattern.zero_count == 0 || largest == 0) return pattern;
  const float clear_from = kClearShare * largest;
  const size_t width = width_px;
  const auto isZero = [&](size_t x, size_t y) { return stored[y * width + x] == 0; };
  std::vector<uint8_t> is_in_column_gap(stored.size());
  for (uint32_t x = 0; x < width_px; ++x) {
    const auto mark = [&](uint32_t first, uint32_t end) {
      for (uint32_t y = first; y < end; ++y) is_in_column_gap[y * width + x] = 1;
    };
    markGaps(
        height_px, [&](uint32_t y) { return stored[y * width + x]; }, clear_from, mark);
  }
  for (uint32_t y = 0; y < height_px; ++y) {
    const auto count = [&](uint32_t first, uint32_t end) {
      bool is_top = y > 0;
      for (uint32_t x = first; x < end; ++x) {
        pattern.enclosed_count += is_in_column_gap[y * width + x];
        is_top = is_top && !isZero(x, y - 1) && is_in_column_gap[y * width + x] != 0;
      }
      pattern.hole_count += is_top ? 1 : 0;
    };
    markGaps(
        width_px, [&](uint32_t x) { return stored[y * width + x]; }, clear_from, count);
    for (uint32_t x = 0; x < width_px; ++x) {
      if (!(stored[y * width + x] >= clear_from)) continue;
      ++pattern.clear_count;
      const bool is_lone_in_row = x > 0 && x + 1 < width_px && isZero(x - 1, y) && isZero(x + 1, y);
      const bool is_lone_in_column =
          y > 0 && y + 1 < height_px && isZero(x, y - 1) && isZero(x, y + 1);
      pattern.lone_count += is_lone_in_row || is_lone_in_column ? 1 : 0;
    }
  }
  return pattern;
}

}  // namespace viewloom::inspect
