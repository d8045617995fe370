// SPDX-License-Identifier: Apache-2.0
// Bands packed without loss are judged by zstd's own decoder.
#include <random>

#include <gtest/gtest.h>
#include <zstd.h>

#include "encode/band_encoder.h"
#include "unit/encode/picture.h"

namespace viewloom::test::lossless_bands_test {
namespace {

Bytes unpacked(const EncodedBand& band) {
  if (band.encoding == BandEncoding::kRaw) return *band.bytes;
  const unsigned long long size = ZSTD_getFrameContentSize(band.bytes->data(), band.bytes->size());
  EXPECT_LT(size, ZSTD_CONTENTSIZE_ERROR) << "the frame states its size";
  Bytes content(size);
  EXPECT_EQ(ZSTD_decompress(content.data(), size, band.bytes->data(), band.bytes->size()), size);
  return content;
}

TEST(BandEncoder, packsColourWithoutLossAsRgb8) {
  BytePool pool(4);
  BandEncoder encoder(pool);
  const Picture picture({123, 77});
  Bytes expected;
  for (uint32_t y = 0; y < 77; ++y) {
    for (uint32_t x = 0; x < 123; ++x) {
      const uint8_t* rgb = &picture.rgbx[y * picture.stride_bytes + 4 * x];
      expected.insert(expected.end(), rgb, rgb + 3);
    }
  }
  for (const BandEncoding color : {BandEncoding::kZstd, BandEncoding::kRaw}) {
    const EncodedBand band =
        encoder.encode(picture.band(0, 77), {.color = color}, layoutOf(picture.size_px));
    EXPECT_EQ(band.encoding, color);
    EXPECT_EQ(unpacked(band), expected);
  }
}

TEST(BandEncoder, packsDepthAndMaskWithoutLossAndWithoutGaps) {
  BytePool pool(4);
  BandEncoder encoder(pool);
  constexpr uint32_t kWidth = 50;
  constexpr uint32_t kHeight = 40;
  for (const AtlasPlane plane : {AtlasPlane::kDepth, AtlasPlane::kMask}) {
    const size_t row_bytes = plane == AtlasPlane::kDepth ? kWidth * 4 : kWidth;
    const size_t stride_bytes = row_bytes + 24;
    std::mt19937 random(3);
    Bytes padded(stride_bytes * kHeight);
    for (uint8_t& byte : padded) byte = static_cast<uint8_t>(random() % 8);
    Bytes expected;
    for (uint32_t y = 0; y < kHeight; ++y) {
      const uint8_t* row = &padded[y * stride_bytes];
      expected.insert(expected.end(), row, row + row_bytes);
    }
    for (const BandEncoding planes : {BandEncoding::kZstd, BandEncoding::kRaw}) {
      const EncodedBand band = encoder.encode({.plane = plane,
                                               .row_count = kHeight,
                                               .width_px = kWidth,
                                               .bytes = padded,
                                               .stride_bytes = stride_bytes},
                                              {.planes = planes}, layoutOf({kWidth, kHeight}));
      EXPECT_EQ(band.encoding, planes);
      EXPECT_EQ(band.plane, plane);
      EXPECT_EQ(unpacked(band), expected);
    }
  }
}

TEST(BandEncoder, packsDepthCodesAsWholeNumbersOf16Bits) {
  BytePool pool(4);
  BandEncoder encoder(pool);
  // Codes from 1/8 to 1/1 1/m, and what lies beyond.
  const std::vector<float> inv_z = {0.125F, 1, 0.5625F, 0, 3, 0.125F + 0.875F * 300.6F / 65535};
  const Bytes expected = {0, 0, 255, 255, 0, 128, 0, 0, 255, 255, 301 % 256, 301 / 256};
  AtlasLayout layout = layoutOf({6, 1});
  layout.depth_codes = DepthCodes{.bits = 16, .inv_z_near = 1, .inv_z_far = 0.125};
  for (const BandEncoding planes : {BandEncoding::kZstd, BandEncoding::kRaw}) {
    const EncodedBand band = encoder.encode(
        {.plane = AtlasPlane::kDepthCodes,
         .row_count = 1,
         .width_px = 6,
         .bytes = {reinterpret_cast<const uint8_t*>(inv_z.data()), inv_z.size() * sizeof(float)},
         .stride_bytes = inv_z.size() * sizeof(float),
         .depth_scale = scaleOf(*layout.depth_codes)},
        {.planes = planes}, layout);
    EXPECT_EQ(band.encoding, planes);
    EXPECT_EQ(unpacked(band), expected);
  }
}

}  // namespace
}  // namespace viewloom::test::lossless_bands_test
