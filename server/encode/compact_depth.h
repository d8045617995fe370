// SPDX-License-Identifier: Apache-2.0
// Packs depth for reprojection: a quarter of the samples, in few bits each.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <zlib.h>

#include "base/byte_pool.h"
#include "encode/band_pixels.h"

namespace viewloom {

// A sample stands for a block of 2 x 2 px (less at odd sides) and is its nearest surface, so that
// no px of a front takes the depth of what lies behind. A band is
//   step: binary32, little endian, 1/m; 0 = everything is infinitely far
//   residuals: a zlib stream (RFC 1950) of ceil(width / 2) * ceil(rows / 2) low bytes, top row
//     first, then as many high bytes
// 1/Z is code * step. The nearest surface of the band has the code kCompactDepthCodeMax. Of a
// translation that moves it by 100 px, no other surface errs by more than 0.013 px.
//
// A code is predicted as left + above - above left, modulo 2^16: 1/Z is linear on planes. The first
// row of a band is predicted as left, its first column as above, its first code as 0. A residual r,
// as int16, is written as r < 0 ? -2 r - 1 : 2 r.
inline constexpr uint32_t kCompactDepthCodeMax = 4095;

// Thread-safety: none; one thread at a time.
class CompactDepthEncoder {
 public:
  // The bands' bytes come from `pool`, which outlives the encoder.
  explicit CompactDepthEncoder(BytePool& pool);
  ~CompactDepthEncoder();
  CompactDepthEncoder(const CompactDepthEncoder&) = delete;
  CompactDepthEncoder& operator=(const CompactDepthEncoder&) = delete;

  // A whole band of kDepth.
  SharedBytes encode(const BandPixels& pixels);

 private:
  void takeNearest(const BandPixels& pixels);
  void writeResiduals(uint32_t columns, uint32_t rows, float codes_per_inv_z);

  BytePool& pool_;
  z_stream stream_{};
  std::vector<float> nearest_;   // 1/m, of each block; top row first
  std::vector<uint16_t> codes_;  // two rows: the one above, and the newest
  std::vector<uint8_t> residuals_;
  std::vector<uint8_t> packed_;  // deflateBound of the largest band so far
};

}  // namespace viewloom
