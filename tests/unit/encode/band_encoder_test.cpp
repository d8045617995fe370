// SPDX-License-Identifier: Apache-2.0
// Bands joined are judged by libjpeg's own call for the whole image.
#include "encode/band_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <jpeglib.h>

#include "support/large_allocations.h"
#include "unit/encode/picture.h"

namespace viewloom::test::band_encoder_test {
namespace {

std::vector<EncodedBand> encodeAll(BandEncoder& encoder, const Picture& picture,
                                   const EncodingSpec& encoding) {
  std::vector<EncodedBand> bands;
  const uint32_t band_rows = bandRowCount(encoding);
  for (uint32_t row = 0; row < picture.size_px.height; row += band_rows) {
    const uint32_t row_count = std::min(band_rows, picture.size_px.height - row);
    bands.push_back(
        encoder.encode(picture.band(row, row_count), encoding, layoutOf(picture.size_px)));
  }
  return bands;
}

Bytes joined(const std::vector<EncodedBand>& bands) {
  Bytes all;
  for (const EncodedBand& band : bands)
    all.insert(all.end(), band.bytes->begin(), band.bytes->end());
  return all;
}

// libjpeg on the whole image in one go, to its own memory destination.
Bytes wholeJpeg(const Picture& picture, const EncodingSpec& encoding) {
  jpeg_compress_struct jpeg;
  jpeg_error_mgr errors;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* out = nullptr;
  unsigned long out_bytes = 0;
  jpeg_mem_dest(&jpeg, &out, &out_bytes);
  jpeg.image_width = picture.size_px.width;
  jpeg.image_height = picture.size_px.height;
  jpeg.input_components = 4;
  jpeg.in_color_space = JCS_EXT_RGBX;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, int(encoding.jpeg_quality), TRUE);
  if (encoding.chroma == Chroma::k444) {
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;
  }
  jpeg.restart_in_rows = 1;
  jpeg_start_compress(&jpeg, TRUE);
  for (uint32_t row = 0; row < picture.size_px.height; ++row) {
    JSAMPROW samples = const_cast<JSAMPROW>(&picture.rgbx[row * picture.stride_bytes]);
    jpeg_write_scanlines(&jpeg, &samples, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const Bytes bytes(out, out + out_bytes);
  std::free(out);
  return bytes;
}

struct DecodedJpeg {
  SizePx size_px;
  bool is_progressive;
  long warning_count;
  Bytes rgbx;
};

DecodedJpeg decodeJpeg(const Bytes& bytes) {
  jpeg_decompress_struct jpeg;
  jpeg_error_mgr errors;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, bytes.data(), bytes.size());
  jpeg_read_header(&jpeg, TRUE);
  jpeg.out_color_space = JCS_EXT_RGBX;
  jpeg_start_decompress(&jpeg);
  DecodedJpeg decoded = {.size_px = {jpeg.output_width, jpeg.output_height},
                         .is_progressive = jpeg.progressive_mode != 0};
  decoded.rgbx.resize(decoded.size_px.area() * 4);
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW row = &decoded.rgbx[size_t{jpeg.output_scanline} * jpeg.output_width * 4];
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  decoded.warning_count = errors.num_warnings;
  jpeg_destroy_decompress(&jpeg);
  return decoded;
}

double rootMeanSquareDifference(const Picture& picture, const Bytes& packed_rgbx) {
  double sum = 0;
  for (uint32_t y = 0; y < picture.size_px.height; ++y) {
    for (uint32_t x = 0; x < picture.size_px.width; ++x) {
      for (uint32_t c = 0; c < 3; ++c) {
        const double difference = picture.rgbx[y * picture.stride_bytes + 4 * x + c] -
                                  packed_rgbx[(size_t{y} * picture.size_px.width + x) * 4 + c];
        sum += difference * difference;
      }
    }
  }
  return std::sqrt(sum / (3.0 * double(picture.size_px.area())));
}

// Heights of one band, of whole bands, of a partial MCU row at the end, of more than 8 bands.
const std::vector<SizePx> kSizes = {{1, 1},     {17, 100}, {64, 128},  {200, 129},
                                    {333, 256}, {96, 700}, {40, 1300}, {1280, 391}};

TEST(BandEncoder, makesBandsThatJoinToTheJpegOfTheWholeImage) {
  BytePool pool(4);
  BandEncoder encoder(pool);
  for (const SizePx size_px : kSizes) {
    for (const Chroma chroma : {Chroma::k420, Chroma::k444}) {
      for (const uint32_t quality : {1u, 50u, 85u, 100u}) {
        const Picture picture(size_px);
        const EncodingSpec encoding = {.jpeg_quality = quality, .chroma = chroma};
        const Bytes bands = joined(encodeAll(encoder, picture, encoding));
        ASSERT_EQ(bands, wholeJpeg(picture, encoding))
            << size_px.width << "x" << size_px.height << " quality " << quality;
      }
    }
  }
}

// In slices of one, two or four rows of MCUs, or however many a lossless band is cut into.
TEST(BandEncoder, makesSlicesThatJoinToTheirBand) {
  BytePool pool(4);
  BandEncoder encoder(pool);
  const Picture picture({333, 391});
  const AtlasLayout layout = layoutOf(picture.size_px);
  for (const EncodingSpec& encoding :
       {EncodingSpec{.chroma = Chroma::k420}, EncodingSpec{.chroma = Chroma::k444},
        EncodingSpec{.jpeg_quality = 100}, EncodingSpec{.color = BandEncoding::kRaw}}) {
    const uint32_t least = leastSliceRowCount(encoding, AtlasPlane::kColor);
    EXPECT_EQ(8 * least, bandRowCount(encoding));
    const std::vector<EncodedBand> bands = encodeAll(encoder, picture, encoding);
    for (const uint32_t slice_rows : {least, 2 * least, 4 * least}) {
      std::vector<EncodedBand> slices;
      for (uint32_t row = 0; row < picture.size_px.height; row += slice_rows) {
        const uint32_t row_count = std::min(slice_rows, picture.size_px.height - row);
        slices.push_back(encoder.encode(picture.band(row, row_count), encoding, layout));
      }
      EXPECT_EQ(joined(slices), joined(bands)) << slice_rows << " rows";
    }
  }
  EXPECT_EQ(leastSliceRowCount({.color = BandEncoding::kZstd}, AtlasPlane::kColor), 128u);
  EXPECT_EQ(leastSliceRowCount({}, AtlasPlane::kDepth), 128u) << "as a Zstandard frame";
}

TEST(BandEncoder, makesABaselineJpegThatDecodesToThePicture) {
  BytePool pool(4);
  BandEncoder encoder(pool);
  const Picture picture({333, 700});
  const DecodedJpeg decoded = decodeJpeg(
      joined(encodeAll(encoder, picture, {.jpeg_quality = 100, .chroma = Chroma::k444})));
  EXPECT_EQ(decoded.size_px, picture.size_px);
  EXPECT_FALSE(decoded.is_progressive);
  EXPECT_EQ(decoded.warning_count, 0);
  // At quality 100 every step is 1: rounding in DCT and colour conversion stays below one level.
  EXPECT_LT(rootMeanSquareDifference(picture, decoded.rgbx), 1);
}

TEST(BandEncoder, packsEachChannelAsAGreyJpeg) {
  BytePool pool(4);
  BandEncoder encoder(pool);
  const Picture picture({77, 150});
  const EncodingSpec encoding = {.color = BandEncoding::kJpegPlanes, .jpeg_quality = 100};
  for (size_t channel = 0; channel < 3; ++channel) {
    Bytes grey;
    for (uint32_t row = 0; row < 150; row += 64) {
      BandPixels pixels = picture.band(row, std::min(64u, 150 - row));
      pixels.plane = kChannelPlanes[channel];
      const EncodedBand band = encoder.encode(pixels, encoding, layoutOf(picture.size_px));
      EXPECT_EQ(band.encoding, BandEncoding::kJpegPlanes);
      EXPECT_EQ(band.plane, kChannelPlanes[channel]);
      grey.insert(grey.end(), band.bytes->begin(), band.bytes->end());
    }
    const DecodedJpeg decoded = decodeJpeg(grey);
    EXPECT_EQ(decoded.size_px, picture.size_px);
    EXPECT_EQ(decoded.warning_count, 0);
    int furthest = 0;
    for (uint32_t y = 0; y < 150; ++y) {
      for (uint32_t x = 0; x < 77; ++x) {
        const int wanted = picture.rgbx[y * picture.stride_bytes + 4 * x + channel];
        furthest = std::max(furthest, std::abs(decoded.rgbx[(77 * y + x) * 4] - wanted));
      }
    }
    EXPECT_LE(furthest, 2);  // of quantising by 1 and two roundings of the transform
  }
}

TEST(BandEncoder, givesTheSameBytesWhicheverInstanceAndOrderPacksThem) {
  BytePool pool(8);
  const Picture picture({400, 640});
  const EncodingSpec encoding;
  BandEncoder one(pool);
  const std::vector<EncodedBand> expected = encodeAll(one, picture, encoding);
  std::vector<EncodedBand> got(expected.size());
  const auto packEverySecond = [&](size_t first) {
    BandEncoder encoder(pool);
    for (size_t i = first; i < got.size(); i += 2) {
      const size_t band = got.size() - 1 - i;
      got[band] = encoder.encode(picture.band(static_cast<uint32_t>(band) * 128, 128), encoding,
                                 layoutOf(picture.size_px));
    }
  };
  {
    std::jthread even(packEverySecond, 0);
    std::jthread odd(packEverySecond, 1);
  }
  for (size_t i = 0; i < got.size(); ++i) EXPECT_EQ(*got[i].bytes, *expected[i].bytes) << i;
}

TEST(BandEncoder, saysWhatABandIs) {
  BytePool pool(4);
  BandEncoder encoder(pool);
  const Picture picture({64, 200});
  const EncodedBand band =
      encoder.encode(picture.band(128, 72), EncodingSpec{}, layoutOf(picture.size_px));
  EXPECT_EQ(band.plane, AtlasPlane::kColor);
  EXPECT_EQ(band.first_row, 128u);
  EXPECT_EQ(band.row_count, 72u);
  EXPECT_EQ(band.encoding, BandEncoding::kJpeg);
}

TEST(BandEncoder, makesNoLargeAllocationOnceWarm) {
  if (!countsLargeAllocations()) GTEST_SKIP() << "the sanitizer's allocator is in use";
  BytePool pool(16);
  BandEncoder encoder(pool);
  const Picture picture({4096, 256});
  const auto encodeEveryWay = [&] {
    for (const BandEncoding color :
         {BandEncoding::kJpeg, BandEncoding::kZstd, BandEncoding::kRaw}) {
      for (const Chroma chroma : {Chroma::k420, Chroma::k444}) {
        encodeAll(encoder, picture, {.color = color, .chroma = chroma});
      }
    }
  };
  for (int i = 0; i < 3; ++i) encodeEveryWay();
  const uint64_t before = largeAllocationCount();
  for (int i = 0; i < 5; ++i) encodeEveryWay();
  EXPECT_EQ(largeAllocationCount() - before, 0u);
  EXPECT_GT(before, 0u) << "the warm-up itself is seen by the counter";
}

}  // namespace
}  // namespace viewloom::test::band_encoder_test
