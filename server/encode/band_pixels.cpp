// SPDX-License-Identifier: Apache-2.0
#include "encode/band_pixels.h"

#include <algorithm>

namespace viewloom {

BandPixels planarPixels(std::span<const uint8_t> planes, SizePx size_px, ColorForm form) {
  const YcbcrLayout layout(size_px, form);
  return {.plane = AtlasPlane::kColor,
          .first_row = 0,
          .row_count = size_px.height,
          .width_px = size_px.width,
          .form = form,
          .bytes = planes.first(layout.lumaBytes()),
          .stride_bytes = layout.luma_stride,
          .cb = planes.subspan(layout.cbOffset(), layout.chromaBytes()),
          .cr = planes.subspan(layout.crOffset(), layout.chromaBytes()),
          .chroma_stride_bytes = layout.chroma_stride};
}

BandPixels colorPixels(std::span<const uint32_t> rgba, std::span<const uint8_t> planes,
                       SizePx size_px, ColorForm form) {
  if (form != ColorForm::kRgba) return planarPixels(planes, size_px, form);
  return {.plane = AtlasPlane::kColor,
          .row_count = size_px.height,
          .width_px = size_px.width,
          .bytes = {reinterpret_cast<const uint8_t*>(rgba.data()), rgba.size_bytes()},
          .stride_bytes = size_t{size_px.width} * sizeof(uint32_t)};
}

BandPixels rowsOf(const BandPixels& pixels, uint32_t row, uint32_t row_count) {
  const auto subrows = [](std::span<const uint8_t> plane, size_t first, size_t count,
                          size_t stride_bytes) {
    return plane.subspan(first * stride_bytes, count * stride_bytes);
  };
  BandPixels rows = pixels;
  rows.first_row += row;
  rows.row_count = std::min(row_count, pixels.row_count - row);
  rows.bytes = subrows(pixels.bytes, row, rows.row_count, pixels.stride_bytes);
  if (pixels.form == ColorForm::kRgba) return rows;
  const uint32_t shared_px = pixels.form == ColorForm::kYcbcr420 ? 2 : 1;
  const uint32_t chroma_count = (rows.row_count + shared_px - 1) / shared_px;
  for (auto* const plane : {&rows.cb, &rows.cr}) {
    *plane = subrows(*plane, row / shared_px, chroma_count, pixels.chroma_stride_bytes);
  }
  return rows;
}

}  // namespace viewloom
