// SPDX-License-Identifier: Apache-2.0
#include "video/tiled_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "video/video_encoder.h"

namespace viewloom::test::tiled_picture_test {
namespace {

constexpr AtlasTiles kPortrait = {
    .atlas_px = {3360, 3360}, .tile_px = {420, 560}, .columns = 8, .rows = 6};
constexpr AtlasTiles kSmall = {
    .atlas_px = {97, 70}, .tile_px = {32, 33}, .columns = 3, .rows = 2, .padding_top_px = 4};

std::vector<uint8_t> flatTiles(const AtlasTiles& atlas, const std::vector<uint8_t>& greys) {
  std::vector<uint8_t> rgb(atlas.atlas_px.area() * 3, 255);
  for (uint32_t y = atlas.padding_top_px; y < atlas.atlas_px.height; ++y) {
    for (uint32_t x = 0; x < atlas.columns * atlas.tile_px.width; ++x) {
      const size_t tile = (y - atlas.padding_top_px) / atlas.tile_px.height * atlas.columns +
                          x / atlas.tile_px.width;
      for (size_t channel = 0; channel < 3; ++channel) {
        rgb[(size_t{y} * atlas.atlas_px.width + x) * 3 + channel] = greys[tile];
      }
    }
  }
  return rgb;
}

TEST(VideoTiles, keepTheirSizeWhereTheyCan) {
  const AtlasTiles atlas = {
      .atlas_px = {1680, 1680}, .tile_px = {210, 280}, .columns = 8, .rows = 6};
  const auto tiles = fitVideoTiles(atlas);
  ASSERT_TRUE(tiles.ok()) << tiles.status();
  EXPECT_EQ(*tiles, (VideoTiles{.tile_px = {210, 280}, .picture_px = {1680, 1680}}));
  EXPECT_EQ(scalingNote(atlas, *tiles), "");
}

TEST(VideoTiles, areScaledToTheCodecsLimit) {
  const auto tiles = fitVideoTiles(kPortrait);
  ASSERT_TRUE(tiles.ok()) << tiles.status();
  EXPECT_EQ(*tiles, (VideoTiles{.tile_px = {384, 512}, .picture_px = {3072, 3072}}));
  EXPECT_THAT(scalingNote(kPortrait, *tiles),
              testing::HasSubstr("the atlas of 3360x3360 px is scaled to 3072x3072 px"));
  EXPECT_EQ(fitVideoTiles(kPortrait, {.area_max_px = kVideoAreaOfLevel6_px})->picture_px,
            (SizePx{3360, 3360}));
  EXPECT_EQ(fitVideoTiles(kSmall)->tile_px, (SizePx{32, 32})) << "tiles have even sides";
}

TEST(VideoTiles, areNeverTooManyForTheCodec) {
  for (const AtlasTiles& atlas :
       {AtlasTiles{.atlas_px = {5999, 5999}, .tile_px = {857, 857}, .columns = 7, .rows = 7},
        AtlasTiles{.atlas_px = {8192, 8192}, .tile_px = {1638, 910}, .columns = 5, .rows = 9},
        AtlasTiles{.atlas_px = {7680, 4320}, .tile_px = {960, 720}, .columns = 8, .rows = 6},
        AtlasTiles{.atlas_px = {16384, 64}, .tile_px = {128, 64}, .columns = 128, .rows = 1}}) {
    const auto tiles = fitVideoTiles(atlas);
    ASSERT_TRUE(tiles.ok()) << tiles.status();
    EXPECT_LE(tiles->picture_px.area(), kVideoAreaMax_px);
    EXPECT_LE(std::max(tiles->picture_px.width, tiles->picture_px.height), 8688U);
    EXPECT_EQ(tiles->tile_px.width % 2 + tiles->tile_px.height % 2, 0U);
    const double aspect = double(atlas.tile_px.width) / atlas.tile_px.height;
    EXPECT_NEAR(double(tiles->tile_px.width) / tiles->tile_px.height, aspect, 0.04 * aspect);
  }
  const AtlasTiles tiny = {.atlas_px = {8, 8}, .tile_px = {8, 8}};
  EXPECT_EQ(fitVideoTiles(tiny).status().code(), absl::StatusCode::kResourceExhausted);
}

TEST(TiledPicture, keepsTilesApart) {
  for (const AtlasTiles& atlas :
       {AtlasTiles{.atlas_px = {64, 32}, .tile_px = {32, 16}, .columns = 2, .rows = 2}, kSmall}) {
    const VideoTiles tiles = *fitVideoTiles(atlas);
    const std::vector<uint8_t> greys = {0, 40, 80, 120, 160, 255};
    TiledPicture picture(atlas, tiles);
    const std::vector<uint8_t> colors = flatTiles(atlas, greys);
    const VideoPicture made = picture.make({.samples = colors.data()});
    EXPECT_EQ(made.size_px, tiles.picture_px);
    for (uint32_t y = 0; y < made.size_px.height; ++y) {
      for (uint32_t x = 0; x < made.size_px.width; ++x) {
        const size_t tile = y / tiles.tile_px.height * atlas.columns + x / tiles.tile_px.width;
        ASSERT_EQ(made.y[y * made.y_stride_bytes + x], greys[tile]) << x << " " << y;
        ASSERT_EQ(made.cb[y / 2 * made.chroma_stride_bytes + x / 2], 128);
        ASSERT_EQ(made.cr[y / 2 * made.chroma_stride_bytes + x / 2], 128);
      }
    }
  }
}

TEST(TiledPicture, hasTheColorsOfJpegFiles) {
  const AtlasTiles atlas = {.atlas_px = {16, 16}, .tile_px = {16, 16}};
  for (const uint32_t channel_count : {3, 4}) {
    std::vector<uint8_t> colors(16 * 16 * channel_count, 0);
    for (size_t i = 0; i < colors.size(); i += channel_count) colors[i] = 200;
    TiledPicture picture(atlas, *fitVideoTiles(atlas));
    const VideoPicture made =
        picture.make({.samples = colors.data(), .channel_count = channel_count});
    EXPECT_EQ(made.y[17], 60);   // 0.299 * 200
    EXPECT_EQ(made.cb[9], 94);   // 128 - 0.1687 * 200
    EXPECT_EQ(made.cr[9], 228);  // 128 + 0.5 * 200
  }
}

// A smooth wave is the same after scaling, at its new places.
TEST(PlaneScaler, keepsSmoothPictures) {
  const SizePx from_px{420, 56};
  const SizePx to_px{382, 50};
  const auto wave = [](double x, double y) { return 128 + 100 * std::sin(x / 9 + y / 17); };
  std::vector<uint8_t> from(from_px.area());
  for (uint32_t y = 0; y < from_px.height; ++y) {
    for (uint32_t x = 0; x < from_px.width; ++x) {
      from[size_t{y} * from_px.width + x] = uint8_t(std::lround(wave(x, y)));
    }
  }
  std::vector<uint8_t> to(to_px.area());
  const double ratio_x = double(from_px.width) / to_px.width;
  const double ratio_y = double(from_px.height) / to_px.height;
  PlaneScaler(from_px, to_px, ratio_x, ratio_y).scale(from.data(), 420, to.data(), 382);
  for (uint32_t y = 2; y < to_px.height - 2; ++y) {
    for (uint32_t x = 2; x < to_px.width - 2; ++x) {
      const double expected = wave((x + 0.5) * ratio_x - 0.5, (y + 0.5) * ratio_y - 0.5);
      ASSERT_NEAR(to[size_t{y} * to_px.width + x], expected, 1.5) << x << " " << y;
    }
  }
}

TEST(PlaneScaler, takesEverySampleAlike) {
  std::vector<uint8_t> from(300 * 4, 0);
  for (size_t x = 0; x < 300; x += 2) {
    for (size_t y = 0; y < 4; ++y) from[y * 300 + x] = 200;
  }
  std::vector<uint8_t> to(100 * 4);
  PlaneScaler({300, 4}, {100, 4}, 3, 1).scale(from.data(), 300, to.data(), 100);
  for (size_t x = 1; x < 99; ++x) EXPECT_NEAR(to[x], 100, 8) << "fine stripes fade";
}

}  // namespace
}  // namespace viewloom::test::tiled_picture_test
