// SPDX-License-Identifier: Apache-2.0
#include "video/view_colors.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/video/sample_picture.h"

namespace viewloom::test::view_colors_test {
namespace {

struct Ycbcr {
  uint8_t y = 0;
  uint8_t cb = 0;
  uint8_t cr = 0;
};

// The transform of JPEG files (JFIF 1.02).
Ycbcr ycbcrOf(double red, double green, double blue) {
  const double y = 0.299 * red + 0.587 * green + 0.114 * blue;
  const auto code = [](double value) { return uint8_t(std::lround(std::min(value, 255.0))); };
  return {code(y), code((blue - y) / 1.772 + 128), code((red - y) / 1.402 + 128)};
}

TEST(ViewColors, givesBackColorsWithinOneCode) {
  for (const int red : {0, 30, 128, 255}) {
    for (const int green : {0, 77, 200, 255}) {
      for (const int blue : {0, 64, 190, 255}) {
        const Ycbcr codes = ycbcrOf(red, green, blue);
        const SamplePicture flat = SamplePicture::flat({16, 16}, codes.y, codes.cb, codes.cr);
        std::vector<uint8_t> rgb(16 * 16 * 3);
        writeViewColors(flat.video(), {.view_px = {16, 16}}, rgb.data(), 16 * 3);
        EXPECT_NEAR(rgb[300], red, 1);
        EXPECT_NEAR(rgb[301], green, 1);
        EXPECT_NEAR(rgb[302], blue, 1);
      }
    }
  }
}

// The views around it are of another colour.
TEST(ViewColors, takesNothingFromNeighbours) {
  SamplePicture picture = SamplePicture::flat({32, 32}, 90, 20, 20);
  for (uint32_t y = 8; y < 22; y += 2) {
    for (uint32_t x = 8; x < 22; x += 2) picture.cb(x, y) = picture.cr(x, y) = 128;
  }
  std::vector<uint8_t> rgb(13 * 14 * 3);
  writeViewColors(picture.video(), {.x_px = 8, .y_px = 8, .view_px = {13, 14}}, rgb.data(), 13 * 3);
  for (const uint8_t code : rgb) ASSERT_EQ(code, 90);
}

TEST(ViewColors, interpolatesChromaBetweenItsSamples) {
  SamplePicture picture = SamplePicture::flat({4, 4}, 128, 128, 128);
  picture.cr(2, 0) = picture.cr(2, 2) = 168;
  std::vector<uint8_t> rgb(4 * 4 * 3);
  writeViewColors(picture.video(), {.view_px = {4, 4}}, rgb.data(), 12);
  const double reds[] = {128, 128 + 1.402 * 10, 128 + 1.402 * 30, 128 + 1.402 * 40};
  for (size_t x = 0; x < 4; ++x) EXPECT_NEAR(rgb[3 * x], reds[x], 1);
}

TEST(ViewColors, writesThemOpaqueAsWell) {
  const SamplePicture picture = SamplePicture::texture({32, 18}, 0);
  std::vector<uint8_t> rgb(31 * 17 * 3);
  std::vector<uint8_t> rgba(31 * 17 * 4);
  writeViewColors(picture.video(), {.view_px = {31, 17}}, rgb.data(), 31 * 3);
  writeOpaqueColors(picture.video(), {.view_px = {31, 17}}, rgba.data(), 31 * 4);
  for (size_t i = 0; i < 31 * 17; ++i) {
    for (size_t c = 0; c < 3; ++c) ASSERT_EQ(rgba[4 * i + c], rgb[3 * i + c]);
    ASSERT_EQ(rgba[4 * i + 3], 255);
  }
}

}  // namespace
}  // namespace viewloom::test::view_colors_test
