// SPDX-License-Identifier: Apache-2.0
// What the encoders take: the traced samples of one band, as they lie in host memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "encode/encoded_band.h"

namespace viewloom {

// Full-width rows of one plane of an atlas. Borrowed: the bytes must stay until encode() returns.
struct BandPixels {
  AtlasPlane plane = AtlasPlane::kColor;
  uint32_t first_row = 0;  // px from the top; a multiple of bandRowCount()
  uint32_t row_count = 0;  // bandRowCount(), fewer only in the last band
  uint32_t width_px = 0;   // of the atlas
  // Top row first. kColor: uint8_t[row][x][4] R, G, B, ignored; kDepth: float[row][x] in 1/m;
  // kMask: uint8_t[row][x], a RayClass.
  std::span<const uint8_t> bytes;
  size_t stride_bytes = 0;  // from row to row
};

}  // namespace viewloom
