// SPDX-License-Identifier: Apache-2.0
#include "encode/picture_planes.h"

#include <algorithm>

#include "base/check.h"
#include "shared/ycbcr.h"

namespace viewloom {
namespace {

// Two rows of R, G, B, ignored, and where their codes go.
struct RowPair {
  const uint8_t* rgba[2];
  uint8_t* luma[2];
  uint8_t* cb;
  uint8_t* cr;
};

void convertPair(const RowPair& pair, uint32_t width_px) {
  for (uint32_t column = 0; column < width_px / 2; ++column) {
    uint32_t cb_sum = 0;
    uint32_t cr_sum = 0;
    for (size_t i = 0; i < 4; ++i) {
      const size_t x = 2 * size_t{column} + i % 2;
      const uint8_t* const px = pair.rgba[i / 2] + 4 * x;
      const float red = px[0];
      const float green = px[1];
      const float blue = px[2];
      pair.luma[i / 2][x] = uint8_t(abi::lumaOf(red, green, blue));
      cb_sum += abi::cbOf(red, green, blue);
      cr_sum += abi::crOf(red, green, blue);
    }
    pair.cb[column] = uint8_t(abi::meanChroma(cb_sum, column));
    pair.cr[column] = uint8_t(abi::meanChroma(cr_sum, column));
  }
}

}  // namespace

PicturePlanes::PicturePlanes(SizePx size_px, BytePool& pool)
    : size_px_(size_px), bytes_(pool.takeAsLeft(size_px.area() * 3 / 2)) {
  VIEWLOOM_CHECK(size_px.width % 2 == 0 && size_px.height % 2 == 0);
}

uint8_t* PicturePlanes::luma(uint32_t row) const {
  return bytes_->data() + size_t{row} * size_px_.width;
}

uint8_t* PicturePlanes::cb(uint32_t row) const {
  return luma(size_px_.height) + size_t{row / 2} * (size_px_.width / 2);
}

uint8_t* PicturePlanes::cr(uint32_t row) const {
  return cb(size_px_.height) + size_t{row / 2} * (size_px_.width / 2);
}

void PicturePlanes::put(const BandPixels& rows) {
  VIEWLOOM_CHECK(rows.width_px == size_px_.width && rows.first_row % 2 == 0);
  VIEWLOOM_CHECK(rows.row_count % 2 == 0 && rows.first_row + rows.row_count <= size_px_.height);
  if (rows.form == ColorForm::kRgba) return convertRows(rows);
  VIEWLOOM_CHECK(rows.form == ColorForm::kYcbcr420);
  copyRows(rows);
}

void PicturePlanes::copyRows(const BandPixels& rows) {
  for (uint32_t i = 0; i < rows.row_count; ++i) {
    std::copy_n(rows.bytes.data() + i * rows.stride_bytes, size_px_.width,
                luma(rows.first_row + i));
  }
  for (uint32_t i = 0; i < rows.row_count / 2; ++i) {
    const uint32_t row = rows.first_row + 2 * i;
    const size_t offset = i * rows.chroma_stride_bytes;
    std::copy_n(rows.cb.data() + offset, size_px_.width / 2, cb(row));
    std::copy_n(rows.cr.data() + offset, size_px_.width / 2, cr(row));
  }
}

void PicturePlanes::convertRows(const BandPixels& rows) {
  for (uint32_t i = 0; i < rows.row_count; i += 2) {
    const uint8_t* const upper = rows.bytes.data() + i * rows.stride_bytes;
    const uint32_t row = rows.first_row + i;
    convertPair({.rgba = {upper, upper + rows.stride_bytes},
                 .luma = {luma(row), luma(row + 1)},
                 .cb = cb(row),
                 .cr = cr(row)},
                size_px_.width);
  }
}

VideoPicture PicturePlanes::video() const {
  return {.size_px = size_px_,
          .y = luma(0),
          .cb = cb(0),
          .cr = cr(0),
          .y_stride_bytes = size_px_.width,
          .chroma_stride_bytes = size_px_.width / 2};
}

}  // namespace viewloom
