// SPDX-License-Identifier: Apache-2.0
#include "decode/predicted_plane.h"

#include <cstddef>
#include <cstring>

#include "base/check.h"

namespace viewloom {
namespace {

constexpr size_t kSampleBytes = sizeof(uint16_t);

uint16_t sampleAt(const uint8_t* samples, size_t index) {
  uint16_t sample = 0;
  std::memcpy(&sample, samples + index * kSampleBytes, kSampleBytes);
  return sample;
}

// 0, 1, 2, 3, ... to 0, -1, 1, -2, ..., modulo 65536.
uint16_t differenceOf(uint32_t zigzag) {
  return static_cast<uint16_t>((zigzag >> 1) ^ (0U - (zigzag & 1)));
}

}  // namespace

void restorePredicted(std::span<const uint8_t> bytes, SizePx size_px, std::vector<uint8_t>& out) {
  const size_t width = size_px.width;
  const size_t area = size_px.area();
  VIEWLOOM_CHECK(bytes.size() == area * kSampleBytes);
  out.resize(bytes.size());
  const std::vector<uint8_t> above_first(width * kSampleBytes);
  const uint8_t* above = above_first.data();
  for (size_t y = 0; y < size_px.height; ++y) {
    const uint8_t* low = &bytes[y * width];
    const uint8_t* high = low + area;
    uint8_t* row = out.data() + y * width * kSampleBytes;
    // left - upper left + difference: what a sample has more than the one above it.
    uint16_t rise = 0;
    for (size_t x = 0; x < width; ++x) {
      rise = static_cast<uint16_t>(rise + differenceOf(low[x] | uint32_t{high[x]} << 8));
      const auto sample = static_cast<uint16_t>(sampleAt(above, x) + rise);
      std::memcpy(row + x * kSampleBytes, &sample, kSampleBytes);
    }
    above = row;
  }
}

}  // namespace viewloom
