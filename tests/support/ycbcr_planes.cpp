// SPDX-License-Identifier: Apache-2.0
#include "support/ycbcr_planes.h"

#include <algorithm>
#include <memory>

#include <turbojpeg.h>

#include "base/check.h"

namespace viewloom::test {
namespace {

constexpr uint32_t kPx_bytes = 4;

// The picture with its last column and row repeated, so that every chroma sample has all its px.
std::vector<uint8_t> paddedPicture(std::span<const uint8_t> rgbx, size_t stride_bytes,
                                   SizePx size_px, SizePx padded_px) {
  std::vector<uint8_t> padded(padded_px.area() * kPx_bytes);
  for (uint32_t y = 0; y < padded_px.height; ++y) {
    const uint8_t* row = rgbx.data() + std::min(y, size_px.height - 1) * stride_bytes;
    for (uint32_t x = 0; x < padded_px.width; ++x) {
      const uint32_t from = std::min(x, size_px.width - 1);
      std::copy_n(row + from * kPx_bytes, kPx_bytes,
                  padded.data() + (size_t{y} * padded_px.width + x) * kPx_bytes);
    }
  }
  return padded;
}

}  // namespace

std::vector<uint8_t> ycbcrPlanesOf(std::span<const uint8_t> rgbx, size_t stride_bytes,
                                   SizePx size_px, ColorForm form) {
  const YcbcrLayout layout(size_px, form);
  const bool is_420 = form == ColorForm::kYcbcr420;
  const uint32_t padded_rows = is_420 ? 2 * layout.chroma_row_count : layout.luma_row_count;
  const SizePx padded_px = {layout.luma_stride, padded_rows};
  const std::vector<uint8_t> padded = paddedPicture(rgbx, stride_bytes, size_px, padded_px);
  // Luma may have a row more than the layout.
  std::vector<uint8_t> luma(padded_px.area());
  std::vector<uint8_t> planes(layout.sizeBytes());
  uint8_t* to[] = {luma.data(), planes.data() + layout.cbOffset(),
                   planes.data() + layout.crOffset()};
  int strides[] = {int(layout.luma_stride), int(layout.chroma_stride), int(layout.chroma_stride)};
  const std::unique_ptr<void, int (*)(void*)> turbojpeg(tjInitCompress(), tjDestroy);
  VIEWLOOM_CHECK(tjEncodeYUVPlanes(turbojpeg.get(), padded.data(), int(padded_px.width), 0,
                                   int(padded_px.height), TJPF_RGBX, to, strides,
                                   is_420 ? TJSAMP_420 : TJSAMP_444, 0) == 0);
  std::copy_n(luma.begin(), layout.lumaBytes(), planes.begin());
  return planes;
}

std::vector<uint8_t> ycbcrPlanesOf(std::span<const uint32_t> rgbx, SizePx size_px, ColorForm form) {
  return ycbcrPlanesOf({reinterpret_cast<const uint8_t*>(rgbx.data()), rgbx.size_bytes()},
                       size_t{size_px.width} * kPx_bytes, size_px, form);
}

}  // namespace viewloom::test
