// SPDX-License-Identifier: Apache-2.0
// Layout of an atlas's colour in memory on its way to the encoders.
#pragma once

#include <cstddef>
#include <cstdint>

#include "display/display_spec.h"
#include "frame/size.h"

namespace viewloom {

// kRgba: uint8_t[row][x][4] R, G, B, 255. The others: planes as JPEG takes them (YcbcrLayout).
enum class ColorForm : uint8_t { kRgba, kYcbcr444, kYcbcr420 };

// Form that costs an encoder the least. Encoders of JPEG and lossless bands also take kRgba, with
// the same result to the byte. Video takes this form alone.
ColorForm directForm(const EncodingSpec& encoding);

// Y, Cb and Cr of an image, one plane after the other, uint8_t[row][stride]. Rows are padded to
// whole MCUs and vectors with samples of their last pixel, as libjpeg pads them.
struct YcbcrLayout {
  uint32_t luma_stride = 0;  // bytes, of 1 px each; a multiple of kPadding_px
  uint32_t luma_row_count = 0;
  uint32_t chroma_stride = 0;
  uint32_t chroma_row_count = 0;

  static constexpr uint32_t kPadding_px = 32;

  // Expects a form other than kRgba.
  YcbcrLayout(SizePx size_px, ColorForm form);

  size_t lumaBytes() const { return size_t{luma_stride} * luma_row_count; }
  size_t chromaBytes() const { return size_t{chroma_stride} * chroma_row_count; }
  size_t cbOffset() const { return lumaBytes(); }
  size_t crOffset() const { return lumaBytes() + chromaBytes(); }
  size_t sizeBytes() const { return lumaBytes() + 2 * chromaBytes(); }
};

}  // namespace viewloom
