// SPDX-License-Identifier: Apache-2.0
// Input of the encoders: the traced samples of one band in host memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "display/color_form.h"
#include "encode/encoded_band.h"
#include "shared/depth_scale.h"

namespace viewloom {

// Full-width rows of one plane of an atlas. Borrowed: the bytes must stay until encode() returns.
struct BandPixels {
  AtlasPlane plane = AtlasPlane::kColor;
  // A band's first_row is a multiple of bandRowCount(), and so is row_count except in the last
  // band; leastSliceRowCount() says which slices of a band there may be.
  uint32_t first_row = 0;  // px from the top
  uint32_t row_count = 0;
  uint32_t width_px = 0;  // of the atlas
  // Form of kColor. JPEG takes its directForm() as well as kRgba; lossless encodings take kRgba
  // alone.
  ColorForm form = ColorForm::kRgba;
  // Top row first. kColor: uint8_t[row][x][4] R, G, B, ignored, or uint8_t[row][x] Y; kRed, kGreen
  // and kBlue: as kColor, of which they are one channel, never in another form than kRgba; kDepth:
  // float[row][x] in 1/m; kMask: uint8_t[row][x], a RayClass; kDepthCodes: as kDepth.
  std::span<const uint8_t> bytes;
  size_t stride_bytes = 0;  // from row to row
  // Chroma of colour that is not kRgba, rows padded as in YcbcrLayout: uint8_t[row][x].
  std::span<const uint8_t> cb, cr;
  size_t chroma_stride_bytes = 0;
  abi::DepthScale depth_scale = {};  // of kDepthCodes: what is made of depth
};

// The colour of `size_px`, from row 0, in planes that lie as YcbcrLayout says. `form`: not kRgba.
BandPixels planarPixels(std::span<const uint8_t> planes, SizePx size_px, ColorForm form);

// The same in any form, of the two the one that is there; RGBA without gaps.
BandPixels colorPixels(std::span<const uint32_t> rgba, std::span<const uint8_t> planes,
                       SizePx size_px, ColorForm form);

// Up to `row_count` of the rows from `row` on, even for 4:2:0; rows have whole strides of bytes.
BandPixels rowsOf(const BandPixels& pixels, uint32_t row, uint32_t row_count);

}  // namespace viewloom
