// SPDX-License-Identifier: Apache-2.0
#include "lib/predict_plane.h"

#include <cstddef>
#include <cstring>

#include "base/check.h"

namespace viewloom {
namespace {

constexpr size_t kSampleBytes = sizeof(uint16_t);

// 0, -1, 1, -2, ... to 0, 1, 2, 3, ..., modulo 65536.
uint16_t zigzag(uint16_t difference) {
  return static_cast<uint16_t>((difference << 1) ^ (0U - (difference >> 15)));
}

}  // namespace

std::vector<uint8_t> predictPlane(std::span<const uint8_t> samples, uint32_t width_px,
                                  uint32_t height_px) {
  const size_t width = width_px;
  const size_t area = width * height_px;
  VIEWLOOM_CHECK(samples.size() == area * kSampleBytes);
  std::vector<uint8_t> out(samples.size());
  // With a 0 to the left of each row: the compiler can then work on many px at once.
  std::vector<uint16_t> above(width + 1);
  std::vector<uint16_t> row(width + 1);
  for (size_t y = 0; y < height_px; ++y) {
    std::memcpy(&row[1], &samples[y * width * kSampleBytes], width * kSampleBytes);
    uint8_t* low = &out[y * width];
    uint8_t* high = low + area;
    for (size_t x = 0; x < width; ++x) {
      const uint16_t z =
          zigzag(static_cast<uint16_t>(row[x + 1] - row[x] - above[x + 1] + above[x]));
      low[x] = static_cast<uint8_t>(z);
      high[x] = static_cast<uint8_t>(z >> 8);
    }
    above.swap(row);
  }
  return out;
}

}  // namespace viewloom
