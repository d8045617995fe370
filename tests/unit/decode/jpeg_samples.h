// SPDX-License-Identifier: Apache-2.0
// Makes JPEGs of every sort, with libjpeg, for tests that read them.
#pragma once

#include <cstdint>
#include <vector>

#include "frame/size.h"

namespace viewloom {

enum class JpegSort : uint8_t {
  kBaseline,
  kGrey,
  kProgressive,
  kArithmetic,
  kCmyk,
  kRgb,  // stored without conversion to YCbCr
  kSeveralScans,
};

// One pixel of the picture in all of them: smooth, so that JPEG keeps it.
void samplePixel(SizePx size_px, uint32_t x, uint32_t y, uint8_t rgb[3]);

std::vector<uint8_t> sampleJpeg(SizePx size_px, JpegSort sort);

}  // namespace viewloom
