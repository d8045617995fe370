// SPDX-License-Identifier: Apache-2.0
#include "video/view_colors.h"

#include <algorithm>
#include <vector>

#include "base/check.h"

namespace viewloom {
namespace {

// Chroma of one row of px, 16 times as large, between two rows of samples. The nearer row and the
// nearer sample of a row count three times as much as the others (centres of 4:2:0 as in JPEG).
class ChromaRow {
 public:
  explicit ChromaRow(uint32_t sample_count) : columns_(sample_count) {}

  // Takes the samples around pixel row `y` from a plane with so many rows.
  void read(const uint8_t* plane, size_t stride_bytes, uint32_t row_count, uint32_t y) {
    const uint32_t near = y / 2;
    const uint32_t far =
        y % 2 == 0 ? (near == 0 ? 0 : near - 1) : std::min(near + 1, row_count - 1);
    const uint8_t* const near_row = plane + near * stride_bytes;
    const uint8_t* const far_row = plane + far * stride_bytes;
    for (size_t i = 0; i < columns_.size(); ++i) columns_[i] = 3 * near_row[i] + far_row[i];
  }
  // Value at pixel `x`, less the code of grey; rounded.
  int at(uint32_t x) const {
    constexpr int kGrey = 128;
    const uint32_t near = x / 2;
    const auto last = uint32_t(columns_.size() - 1);
    const uint32_t far = x % 2 == 0 ? (near == 0 ? 0 : near - 1) : std::min(near + 1, last);
    return ((3 * columns_[near] + columns_[far] + 8) >> 4) - kGrey;
  }

 private:
  std::vector<int> columns_;
};

uint8_t clampedCode(int value) {
  return uint8_t(std::clamp(value, 0, 255));
}

// The inverse of shared/ycbcr.h: R = Y + 1.402 Cr, B = Y + 1.772 Cb,
// G = Y - 0.344136 Cb - 0.714136 Cr, with coefficients of 16 bits.
void writePixel(uint8_t* rgb, int luma, int cb, int cr) {
  constexpr int kHalf = 32768;
  rgb[0] = clampedCode(luma + ((91881 * cr + kHalf) >> 16));
  rgb[1] = clampedCode(luma + ((-22554 * cb - 46802 * cr + kHalf) >> 16));
  rgb[2] = clampedCode(luma + ((116130 * cb + kHalf) >> 16));
}

// `kPixelBytes`: 3, or 4 with 255 behind each colour.
template <size_t kPixelBytes>
void writeColors(const VideoPicture& picture, const PictureCell& cell, uint8_t* pixels,
                 size_t stride_bytes) {
  const SizePx view_px = cell.view_px;
  VIEWLOOM_CHECK(cell.x_px % 2 == 0 && cell.y_px % 2 == 0 && view_px.area() > 0);
  VIEWLOOM_CHECK(cell.x_px + view_px.width <= picture.size_px.width);
  VIEWLOOM_CHECK(cell.y_px + view_px.height <= picture.size_px.height);
  const SizePx chroma_px = {(view_px.width + 1) / 2, (view_px.height + 1) / 2};
  const size_t chroma_origin = size_t{cell.y_px / 2} * picture.chroma_stride_bytes + cell.x_px / 2;
  ChromaRow cb(chroma_px.width);
  ChromaRow cr(chroma_px.width);
  for (uint32_t y = 0; y < view_px.height; ++y) {
    cb.read(picture.cb + chroma_origin, picture.chroma_stride_bytes, chroma_px.height, y);
    cr.read(picture.cr + chroma_origin, picture.chroma_stride_bytes, chroma_px.height, y);
    const uint8_t* const luma =
        picture.y + size_t{cell.y_px + y} * picture.y_stride_bytes + cell.x_px;
    uint8_t* const row = pixels + y * stride_bytes;
    for (uint32_t x = 0; x < view_px.width; ++x) {
      writePixel(row + kPixelBytes * x, luma[x], cb.at(x), cr.at(x));
      if constexpr (kPixelBytes == 4) row[kPixelBytes * x + 3] = 255;
    }
  }
}

}  // namespace

void writeViewColors(const VideoPicture& picture, const PictureCell& cell, uint8_t* rgb,
                     size_t stride_bytes) {
  writeColors<3>(picture, cell, rgb, stride_bytes);
}

void writeOpaqueColors(const VideoPicture& picture, const PictureCell& cell, uint8_t* rgba,
                       size_t stride_bytes) {
  writeColors<4>(picture, cell, rgba, stride_bytes);
}

}  // namespace viewloom
