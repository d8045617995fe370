// SPDX-License-Identifier: Apache-2.0
#include "encode/band_encoder.h"

#include "base/check.h"
#include "encode/compact_depth.h"
#include "encode/jpeg_encoder.h"
#include "encode/lossless_encoder.h"

namespace viewloom {
namespace {

void checkPlane(std::span<const uint8_t> bytes, size_t row_count, size_t stride_bytes,
                size_t row_bytes) {
  VIEWLOOM_CHECK(stride_bytes >= row_bytes);
  VIEWLOOM_CHECK(bytes.size() >= (row_count - 1) * stride_bytes + row_bytes);
}

void checkPlanes(const BandPixels& pixels, const EncodingSpec& encoding) {
  if (!isColor(pixels.plane) || pixels.form == ColorForm::kRgba) {
    const size_t sample_bytes = pixels.plane == AtlasPlane::kMask ? 1 : 4;
    return checkPlane(pixels.bytes, pixels.row_count, pixels.stride_bytes,
                      sample_bytes * pixels.width_px);
  }
  VIEWLOOM_CHECK(pixels.form == directForm(encoding));
  const YcbcrLayout layout({pixels.width_px, pixels.row_count}, pixels.form);
  checkPlane(pixels.bytes, layout.luma_row_count, pixels.stride_bytes, layout.luma_stride);
  for (const auto chroma : {pixels.cb, pixels.cr}) {
    checkPlane(chroma, layout.chroma_row_count, pixels.chroma_stride_bytes, layout.chroma_stride);
  }
}

void checkShape(const BandPixels& pixels, const EncodingSpec& encoding, SizePx atlas_size_px) {
  VIEWLOOM_CHECK(pixels.width_px == atlas_size_px.width);
  const uint32_t least = leastSliceRowCount(encoding, pixels.plane);
  VIEWLOOM_CHECK(pixels.first_row % least == 0);
  const uint32_t end_row = pixels.first_row + pixels.row_count;
  VIEWLOOM_CHECK(pixels.row_count % least == 0 || end_row == atlas_size_px.height);
  VIEWLOOM_CHECK(pixels.row_count > 0);
  const uint32_t band_rows = bandRowCount(encoding);
  VIEWLOOM_CHECK(pixels.first_row % band_rows + pixels.row_count <= band_rows);
  checkPlanes(pixels, encoding);
}

BandEncoding encodingOf(const EncodingSpec& encoding, AtlasPlane plane) {
  return isColor(plane) ? encoding.color : encoding.planes;
}

}  // namespace

// Rows of MCUs, of which a band has eight; what is compressed as one stream is a whole band.
uint32_t leastSliceRowCount(const EncodingSpec& encoding, AtlasPlane plane) {
  constexpr uint32_t kMcuRows = 8;
  const BandEncoding packing = encodingOf(encoding, plane);
  const bool is_whole = packing == BandEncoding::kZstd || packing == BandEncoding::kCompactDepth;
  return bandRowCount(encoding) / (is_whole ? 1 : kMcuRows);
}

BandEncoder::BandEncoder(BytePool& pool)
    : jpeg_(std::make_unique<JpegEncoder>(pool)),
      lossless_(std::make_unique<LosslessEncoder>(pool)),
      pool_(pool) {}

BandEncoder::~BandEncoder() = default;

EncodedBand BandEncoder::encode(const BandPixels& pixels, const EncodingSpec& encoding,
                                const AtlasLayout& layout) {
  checkShape(pixels, encoding, layout.imageSize());
  EncodedBand band = {.plane = pixels.plane,
                      .first_row = pixels.first_row,
                      .row_count = pixels.row_count,
                      .encoding = encodingOf(encoding, pixels.plane),
                      .bytes = nullptr};
  switch (band.encoding) {
    case BandEncoding::kJpeg:
    case BandEncoding::kJpegPlanes:
      VIEWLOOM_CHECK(isColor(pixels.plane));
      band.bytes = jpeg_->encode(pixels, encoding, layout);
      break;
    case BandEncoding::kZstd:
      band.bytes = lossless_->encodeZstd(pixels);
      break;
    case BandEncoding::kRaw:
      band.bytes = lossless_->encodeRaw(pixels);
      break;
    case BandEncoding::kH264:
      failCheck(__FILE__, __LINE__, "video is coded in whole pictures (picture_planes.h)");
    case BandEncoding::kCompactDepth:
      VIEWLOOM_CHECK(pixels.plane == AtlasPlane::kDepth);
      if (!compact_depth_) compact_depth_ = std::make_unique<CompactDepthEncoder>(pool_);
      band.bytes = compact_depth_->encode(pixels);
      break;
  }
  return band;
}

}  // namespace viewloom
