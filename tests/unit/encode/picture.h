// SPDX-License-Identifier: Apache-2.0
// A picture to pack, rows with gaps between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "encode/band_pixels.h"

namespace viewloom::test {

using Bytes = std::vector<uint8_t>;

// Smooth colour with noise and hard edges, so that blocks of every kind occur. RGBX, with a gap of
// 12 bytes behind each row.
struct Picture {
  SizePx size_px;
  size_t stride_bytes;
  Bytes rgbx;

  explicit Picture(SizePx size, uint32_t seed = 1)
      : size_px(size), stride_bytes(size.width * 4 + 12), rgbx(stride_bytes * size.height, 0xEE) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> noise(-6, 6);
    for (uint32_t y = 0; y < size.height; ++y) {
      for (uint32_t x = 0; x < size.width; ++x) {
        const int edge = (x / 37 + y / 53) % 2 != 0 ? 60 : 0;
        for (uint32_t c = 0; c < 3; ++c) {
          const double wave = 90 + 40 * std::sin((x + 20.0 * c) / 31.0) + 40 * std::cos(y / 47.0);
          const int value = static_cast<int>(wave) + edge + noise(random);
          rgbx[y * stride_bytes + 4 * x + c] = static_cast<uint8_t>(std::clamp(value, 0, 255));
        }
      }
    }
  }

  BandPixels band(uint32_t first_row, uint32_t row_count) const {
    return {.plane = AtlasPlane::kColor,
            .first_row = first_row,
            .row_count = row_count,
            .width_px = size_px.width,
            .bytes = std::span(rgbx).subspan(first_row * stride_bytes, row_count * stride_bytes),
            .stride_bytes = stride_bytes};
  }
};

inline AtlasLayout layoutOf(SizePx size_px) {
  AtlasLayout layout;
  layout.size_px = size_px;
  return layout;
}

}  // namespace viewloom::test
