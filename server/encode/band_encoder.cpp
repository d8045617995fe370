// SPDX-License-Identifier: Apache-2.0
#include "encode/band_encoder.h"

#include "base/check.h"
#include "encode/jpeg_encoder.h"
#include "encode/lossless_encoder.h"

namespace viewloom {
namespace {

size_t sampleBytes(AtlasPlane plane) {
  return plane == AtlasPlane::kMask ? 1 : 4;
}

void checkShape(const BandPixels& pixels, const EncodingSpec& encoding, SizePx atlas_size_px) {
  VIEWLOOM_CHECK(pixels.width_px == atlas_size_px.width);
  VIEWLOOM_CHECK(pixels.first_row % bandRowCount(encoding) == 0);
  const uint32_t end_row = pixels.first_row + pixels.row_count;
  VIEWLOOM_CHECK(pixels.row_count == bandRowCount(encoding) || end_row == atlas_size_px.height);
  const size_t row_bytes = sampleBytes(pixels.plane) * pixels.width_px;
  VIEWLOOM_CHECK(pixels.row_count > 0 && pixels.stride_bytes >= row_bytes);
  VIEWLOOM_CHECK(pixels.bytes.size() >= (pixels.row_count - 1) * pixels.stride_bytes + row_bytes);
}

}  // namespace

BandEncoder::BandEncoder(BytePool& pool)
    : jpeg_(std::make_unique<JpegEncoder>(pool)),
      lossless_(std::make_unique<LosslessEncoder>(pool)) {}

BandEncoder::~BandEncoder() = default;

EncodedBand BandEncoder::encode(const BandPixels& pixels, const EncodingSpec& encoding,
                                const AtlasLayout& layout) {
  checkShape(pixels, encoding, layout.size_px);
  EncodedBand band = {
      .plane = pixels.plane,
      .first_row = pixels.first_row,
      .row_count = pixels.row_count,
      .encoding = pixels.plane == AtlasPlane::kColor ? encoding.color : encoding.planes,
      .bytes = nullptr};
  switch (band.encoding) {
    case BandEncoding::kJpeg:
      VIEWLOOM_CHECK(pixels.plane == AtlasPlane::kColor);
      band.bytes = jpeg_->encode(pixels, encoding, layout.size_px.height);
      break;
    case BandEncoding::kZstd:
      band.bytes = lossless_->encodeZstd(pixels);
      break;
    case BandEncoding::kRaw:
      band.bytes = lossless_->encodeRaw(pixels);
      break;
  }
  return band;
}

}  // namespace viewloom
