// SPDX-License-Identifier: Apache-2.0
#include "lib/atlas.h"

#include <gtest/gtest.h>
#include <turbojpeg.h>
#include <zstd.h>

#include <cstdlib>

namespace viewloom::atlas_test {
namespace {

// 2 columns x 3 rows of 5x4 tiles, and padding: 1 px at the right, 2 px at the top.
v1::AtlasLayout layoutOf(v1::TileOrder order) {
  v1::AtlasLayout layout;
  layout.mutable_size()->set_width(11);
  layout.mutable_size()->set_height(14);
  layout.set_columns(2);
  layout.set_rows(3);
  layout.mutable_tile_size()->set_width(5);
  layout.mutable_tile_size()->set_height(4);
  layout.set_order(order);
  layout.set_view_count(6);
  layout.set_padding_right_px(1);
  layout.set_padding_top_px(2);
  return layout;
}

Atlas emptyAtlas() {
  return {.layout = std::make_shared<const v1::AtlasLayout>(layoutOf(v1::TILE_ORDER_BOTTOM_LEFT)),
          .header = {},
          .bands = {}};
}

AtlasBand band(v1::AtlasPlane plane, v1::BandEncoding encoding, uint32_t first_row,
               uint32_t row_count, std::string bytes) {
  return {.image_index = 0,
          .plane = plane,
          .first_row = first_row,
          .row_count = row_count,
          .encoding = encoding,
          .bytes = std::move(bytes)};
}

std::string zstd(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  return out;
}

std::string greyJpeg(uint8_t grey) {
  const std::vector<uint8_t> samples(size_t{11} * 14 * 3, grey);
  tjhandle handle = tjInitCompress();
  unsigned char* out = nullptr;
  unsigned long size = 0;
  EXPECT_EQ(
      tjCompress2(handle, samples.data(), 11, 0, 14, TJPF_RGB, &out, &size, TJSAMP_444, 95, 0), 0);
  std::string bytes(reinterpret_cast<char*>(out), size);
  tjFree(out);
  tjDestroy(handle);
  return bytes;
}

TEST(Atlas, joinsJpegBandsByteForByte) {
  const std::string jpeg = greyJpeg(90);
  Atlas atlas = emptyAtlas();
  const auto add = [&](uint32_t row, uint32_t rows, const std::string& bytes) {
    atlas.bands.push_back(band(v1::ATLAS_PLANE_COLOR, v1::BAND_ENCODING_JPEG, row, rows, bytes));
  };
  add(0, 8, jpeg.substr(0, 100));
  atlas.bands.push_back(band(v1::ATLAS_PLANE_MASK, v1::BAND_ENCODING_RAW, 0, 14, "mask"));
  add(8, 6, jpeg.substr(100));
  const auto joined = joinJpegBands(atlas);
  ASSERT_TRUE(joined.ok()) << joined.status();
  EXPECT_EQ(*joined, jpeg);
  const auto picture = decodePlane(atlas, v1::ATLAS_PLANE_COLOR);
  ASSERT_TRUE(picture.ok()) << picture.status();
  EXPECT_EQ(picture->channels, 3U);
  EXPECT_NEAR(picture->samples[3 * 77], 90, 2);
}

TEST(Atlas, saysWhatIsMissing) {
  Atlas atlas = emptyAtlas();
  EXPECT_EQ(decodePlane(atlas, v1::ATLAS_PLANE_MASK).status().code(),
            absl::StatusCode::kFailedPrecondition);
  atlas.bands.push_back(band(v1::ATLAS_PLANE_COLOR, v1::BAND_ENCODING_JPEG, 0, 8, "top"));
  EXPECT_FALSE(hasWholePlane(atlas, v1::ATLAS_PLANE_COLOR));
  EXPECT_FALSE(joinJpegBands(atlas).ok()) << "rows 8..13 are missing";
  atlas.bands.push_back(band(v1::ATLAS_PLANE_COLOR, v1::BAND_ENCODING_RAW, 8, 6, "rest"));
  EXPECT_TRUE(hasWholePlane(atlas, v1::ATLAS_PLANE_COLOR));
  EXPECT_FALSE(joinJpegBands(atlas).ok()) << "not all bands are JPEG";
}

TEST(Atlas, unpacksZstdAndRawBands) {
  Atlas atlas = emptyAtlas();
  const std::string top(11 * 8, '\1');
  const std::string rest(11 * 6, '\3');
  atlas.bands.push_back(band(v1::ATLAS_PLANE_MASK, v1::BAND_ENCODING_ZSTD, 0, 8, zstd(top)));
  atlas.bands.push_back(band(v1::ATLAS_PLANE_MASK, v1::BAND_ENCODING_RAW, 8, 6, rest));
  const auto picture = decodePlane(atlas, v1::ATLAS_PLANE_MASK);
  ASSERT_TRUE(picture.ok()) << picture.status();
  EXPECT_EQ(std::string(picture->samples.begin(), picture->samples.end()), top + rest);
}

TEST(Atlas, refusesBandsThatDoNotFillTheirRows) {
  for (const std::string& bytes : {std::string("x"), zstd(std::string(11 * 14 + 1, 'x')),
                                   zstd(std::string(11 * 14 - 1, 'x')), std::string()}) {
    Atlas atlas = emptyAtlas();
    atlas.bands.push_back(band(v1::ATLAS_PLANE_MASK, v1::BAND_ENCODING_ZSTD, 0, 14, bytes));
    EXPECT_EQ(decodePlane(atlas, v1::ATLAS_PLANE_MASK).status().code(),
              absl::StatusCode::kDataLoss);
  }
  Atlas atlas = emptyAtlas();
  atlas.bands.push_back(
      band(v1::ATLAS_PLANE_COLOR, v1::BAND_ENCODING_JPEG, 0, 14, greyJpeg(9).substr(0, 300)));
  EXPECT_EQ(decodePlane(atlas, v1::ATLAS_PLANE_COLOR).status().code(), absl::StatusCode::kDataLoss);
}

TEST(Atlas, refusesJpegWhereSamplesHaveTwoOrFourBytes) {
  for (const auto plane : {v1::ATLAS_PLANE_DEPTH, v1::ATLAS_PLANE_DEPTH_CODES}) {
    Atlas atlas = emptyAtlas();
    atlas.bands.push_back(band(plane, v1::BAND_ENCODING_JPEG, 0, 14, greyJpeg(9)));
    EXPECT_EQ(decodePlane(atlas, plane).status().code(), absl::StatusCode::kDataLoss);
  }
}

// Every sample says its own place: 16 * y + x.
AtlasPicture placeMarks() {
  AtlasPicture picture{.width_px = 11, .height_px = 14, .channels = 1, .samples = {}};
  for (int y = 0; y < 14; ++y) {
    for (int x = 0; x < 11; ++x) picture.samples.push_back(static_cast<uint8_t>(16 * y + x));
  }
  return picture;
}

TEST(Atlas, cutsViewsFromTheBottomOfAQuilt) {
  const v1::AtlasLayout layout = layoutOf(v1::TILE_ORDER_BOTTOM_LEFT);
  const AtlasPicture first = cutView(placeMarks(), layout, 0);
  EXPECT_EQ(first.width_px, 5U);
  EXPECT_EQ(first.height_px, 4U);
  EXPECT_EQ(first.samples.front(), 16 * 10 + 0) << "bottom left, under two rows and the padding";
  EXPECT_EQ(first.samples.back(), 16 * 13 + 4);
  EXPECT_EQ(cutView(placeMarks(), layout, 1).samples.front(), 16 * 10 + 5);
  EXPECT_EQ(cutView(placeMarks(), layout, 5).samples.front(), 16 * 2 + 5);
}

TEST(Atlas, cutsViewsFromTheTopOfACameraGrid) {
  v1::AtlasLayout layout = layoutOf(v1::TILE_ORDER_TOP_LEFT);
  EXPECT_EQ(cutView(placeMarks(), layout, 0).samples.front(), 16 * 2);
  EXPECT_EQ(cutView(placeMarks(), layout, 3).samples.front(), 16 * 6 + 5);
}

}  // namespace
}  // namespace viewloom::atlas_test
