// SPDX-License-Identifier: Apache-2.0
// How the colour of an atlas lies in memory on its way to the encoders.
#pragma once

#include <cstddef>
#include <cstdint>

#include "display/display_spec.h"
#include "frame/size.h"

namespace viewloom {

// kRgba: uint8_t[row][x][4] R, G, B, 255. Else planes as JPEG takes them (YcbcrLayout).
enum class ColorForm : uint8_t { kRgba, kYcbcr444, kYcbcr420 };

// The form in which an encoder has the least to do. Every encoder takes kRgba; what it makes of
// either is the same to the byte.
ColorForm directForm(const EncodingSpec& encoding);

// Y, Cb and Cr of an image, one plane after the other, uint8_t[row][stride]. Rows are padded with
// samples of their last px, as libjpeg pads them, to whole MCUs and to whole vectors.
struct YcbcrLayout {
  uint32_t luma_stride = 0;  // bytes, of 1 px each; a multiple of kPadding_px
  uint32_t luma_row_count = 0;
  uint32_t chroma_stride = 0;
  uint32_t chroma_row_count = 0;

  static constexpr uint32_t kPadding_px = 32;

  // `form`: not kRgba.
  YcbcrLayout(SizePx size_px, ColorForm form);

  size_t lumaBytes() const { return size_t{luma_stride} * luma_row_count; }
  size_t chromaBytes() const { return size_t{chroma_stride} * chroma_row_count; }
  size_t cbOffset() const { return lumaBytes(); }
  size_t crOffset() const { return lumaBytes() + chromaBytes(); }
  size_t sizeBytes() const { return lumaBytes() + 2 * chromaBytes(); }
};

}  // namespace viewloom
