// SPDX-License-Identifier: Apache-2.0
#include "decode/predicted_plane.h"

#include <cstddef>
#include <cstring>

#include "base/check.h"

namespace viewloom {
namespace {

constexpr size_t kSampleBytes = sizeof(uint16_t);

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
  std::vector<uint16_t> differences(width);
  std::vector<uint16_t> row(width);  // that above, until it is this one
  for (size_t y = 0; y < size_px.height; ++y) {
    const uint8_t* low = &bytes[y * width];
    const uint8_t* high = low + area;
    for (size_t x = 0; x < width; ++x) {
      differences[x] = differenceOf(low[x] | uint32_t{high[x]} << 8);
    }
    // left - upper left + difference: what a sample has more than the one above it. Apart from the
    // loop before, of which many px are done at a time.
    uint32_t rise = 0;
    for (size_t x = 0; x < width; ++x) {
      rise += differences[x];
      row[x] = static_cast<uint16_t>(row[x] + rise);
    }
    std::memcpy(out.data() + y * width * kSampleBytes, row.data(), width * kSampleBytes);
  }
}

}  // namespace viewloom
