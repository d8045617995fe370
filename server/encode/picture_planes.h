// SPDX-License-Identifier: Apache-2.0
// Planes of one picture of a video, which are filled row by row.
#pragma once

#include <cstdint>

#include "base/byte_pool.h"
#include "encode/band_pixels.h"
#include "video/video_picture.h"

namespace viewloom {

// Y'CbCr 4:2:0 as encoders take it, without padding. Thread-safety: put() from several threads at
// once, for different rows.
class PicturePlanes {
 public:
  // Expects even sides. The bytes come from `pool`.
  PicturePlanes(SizePx size_px, BytePool& pool);

  // Rows of colour, kYcbcr420 or kRgba, from an even row on; an even count of them.
  void put(const BandPixels& rows);
  // Once all rows are there; valid while this is.
  VideoPicture video() const;

 private:
  uint8_t* luma(uint32_t row) const;
  uint8_t* cb(uint32_t row) const;
  uint8_t* cr(uint32_t row) const;
  void copyRows(const BandPixels& rows);
  void convertRows(const BandPixels& rows);

  SizePx size_px_;
  BytePool::Buffer bytes_;  // Y, Cb, Cr
};

}  // namespace viewloom
