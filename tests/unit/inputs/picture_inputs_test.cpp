// SPDX-License-Identifier: Apache-2.0
// Pictures that hold colour and depth side by side, and depth of sensors, headsets, phones and
// networks, against distances worked out by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "unit/inputs/written_pair.h"

namespace viewloom::test::picture_inputs_test {
namespace {

using ::testing::HasSubstr;

class PictureInputsTest : public WrittenPairTest {
 protected:
  // Green colour and grey depth of 4x4 each: black at the left of the depth, then 85, 170, 255.
  void writeHalves(v1::ImagePart depth_side) const {
    const bool beside = depth_side == v1::IMAGE_PART_LEFT || depth_side == v1::IMAGE_PART_RIGHT;
    const bool is_last = depth_side == v1::IMAGE_PART_RIGHT || depth_side == v1::IMAGE_PART_BOTTOM;
    const uint32_t width = beside ? 8 : 4, height = beside ? 4 : 8;
    std::vector<uint16_t> rgb;
    for (uint32_t y = 0; y < height; ++y) {
      for (uint32_t x = 0; x < width; ++x) {
        const bool is_depth = ((beside ? x : y) >= 4) == is_last;
        const auto code = static_cast<uint16_t>(85 * (x % 4));
        if (is_depth) rgb.insert(rgb.end(), {code, code, code});
        if (!is_depth) rgb.insert(rgb.end(), {0, 200, 0});
      }
    }
    writePng(file("rgbd.png"), width, height, 3, 8, rgb);
  }
};

TEST_F(PictureInputsTest, findsTheHalvesInAllFourPlacements) {
  for (const v1::ImagePart side :
       {v1::IMAGE_PART_RIGHT, v1::IMAGE_PART_LEFT, v1::IMAGE_PART_TOP, v1::IMAGE_PART_BOTTOM}) {
    writeHalves(side);
    const auto read =
        readInput({.kind = InputKind::kRgbd, .near_m = 1, .far_m = 4, .depth_side = side},
                  {.color = file("rgbd.png")});
    // 1/Z: 0.25, 0.5, 0.75, 1.
    EXPECT_NEAR(depthAt(read, 0, 0), 4, 1e-5) << side;
    EXPECT_NEAR(depthAt(read, 1, 3), 2, 1e-5) << side;
    EXPECT_NEAR(depthAt(read, 2, 1), 4.0 / 3, 1e-5) << side;
    EXPECT_NEAR(depthAt(read, 3, 2), 1, 1e-5) << side;
    const WireFrame& frame = read.frame.wire;
    EXPECT_EQ(frame.header.sources(0).layers(0).planes(0).size().width(), 4U);
    EXPECT_EQ((*frame.planes[0])[1], 200) << side;
    EXPECT_EQ((*frame.planes[0])[0], 0) << side;
  }
}

TEST_F(PictureInputsTest, turnsBlackNearAndLinearDepth) {
  writeHalves(v1::IMAGE_PART_RIGHT);
  const InputSettings settings{.kind = InputKind::kRgbd, .near_m = 1, .far_m = 4};
  InputSettings black = settings;
  black.is_black_near = true;
  EXPECT_NEAR(depthAt(readInput(black, {.color = file("rgbd.png")}), 0, 0), 1, 1e-5);
  InputSettings planar = settings;
  planar.depth_meaning = v1::DEPTH_MEANING_PLANAR;
  EXPECT_NEAR(depthAt(readInput(planar, {.color = file("rgbd.png")}), 1, 0), 3, 1e-5);
  InputSettings sky = settings;
  sky.far_m = kInfinity;
  EXPECT_EQ(depthAt(readInput(sky, {.color = file("rgbd.png")}), 0, 0), kInfinity);
}

TEST_F(PictureInputsTest, keepsAll16BitsOfHalves) {
  // Two px of colour, two of depth: 0x0101 codes differ from those of 8 bits.
  writePng(file("deep.png"), 4, 1, 3, 16,
           {1, 2, 3, 4, 5, 6, 0x8001, 0x8001, 0x8001, 0xFFFF, 0xFFFF, 0xFFFF});
  const auto read = readInput({.kind = InputKind::kRgbd, .near_m = 1, .far_m = kInfinity},
                              {.color = file("deep.png")});
  EXPECT_NEAR(depthAt(read, 0, 0), 65535.0 / 0x8001, 1e-6);
}

TEST_F(PictureInputsTest, readsHalvesOfJpegs) {
  std::vector<uint8_t> rgb;
  for (int i = 0; i < 32 * 16; ++i) {
    const bool is_depth = i % 32 >= 16;
    rgb.insert(rgb.end(), {uint8_t(is_depth ? 128 : 30), uint8_t(is_depth ? 128 : 160), 128});
  }
  writeJpeg(file("rgbd.jpg"), 32, 16, rgb);
  const auto read = readInput({.kind = InputKind::kRgbd, .near_m = 1, .far_m = kInfinity},
                              {.color = file("rgbd.jpg")});
  EXPECT_NEAR(depthAt(read, 8, 8), 255.0 / 128, 0.03);
}

TEST_F(PictureInputsTest, saysWhatIsWrongWithHalves) {
  writeHalves(v1::IMAGE_PART_RIGHT);
  const InputSettings settings{.kind = InputKind::kRgbd, .near_m = 1, .far_m = 4};
  InputSettings wrong = settings;
  wrong.depth_side = v1::IMAGE_PART_LEFT;
  EXPECT_THAT(refusalOf(wrong, {.color = file("rgbd.png")}), HasSubstr("is coloured; accepted"));
  wrong = settings;
  wrong.far_m = 0.5;
  EXPECT_THAT(refusalOf(wrong, {.color = file("rgbd.png")}),
              HasSubstr("--depth-near is 1 and --depth-far 0.5; accepted are"));
  writePng(file("rgbd2.png"), 4, 2, 1, 8, std::vector<uint16_t>(8, 7));
  EXPECT_THAT(refusalOf(settings, {.color = file("rgbd.png"), .depth = file("rgbd2.png")}),
              HasSubstr("reads colour and depth from one file"));
  writePng(file("odd.png"), 5, 2, 1, 8, std::vector<uint16_t>(10, 7));
  EXPECT_THAT(refusalOf(settings, {.color = file("odd.png")}), HasSubstr("need an even width"));
}

TEST_F(PictureInputsTest, places2dPlusZAboutTheScreen) {
  writePng(file("2dz.png"), 6, 1, 1, 8, {10, 20, 30, 0, 128, 255});
  const auto read =
      readInput({.kind = InputKind::k2dPlusZ, .screen_m = 2}, {.color = file("2dz.png")});
  EXPECT_NEAR(depthAt(read, 0, 0), 2 / (1 - 128.0 / 255), 1e-4);
  EXPECT_NEAR(depthAt(read, 1, 0), 2, 1e-5) << "code 128 lies in the screen";
  EXPECT_NEAR(depthAt(read, 2, 0), 2 / (1 + 127.0 / 255), 1e-5);
  const auto half =
      readInput({.kind = InputKind::k2dPlusZ, .screen_m = 2, .factor = 32, .screen_code = 0},
                {.color = file("2dz.png")});
  EXPECT_NEAR(depthAt(half, 0, 0), 2, 1e-5) << "all in front";
  EXPECT_NEAR(depthAt(half, 2, 0), 2 / 1.5, 1e-5);
  for (const double factor : {200.0, 0.0, kInfinity, std::nan("")}) {
    EXPECT_THAT(refusalOf({.kind = InputKind::k2dPlusZ, .factor = factor, .screen_code = 128},
                          {.color = file("2dz.png")}),
                HasSubstr("put black behind infinity"));
  }
}

TEST_F(PictureInputsTest, readsSensorsInMillimetresAtTheirOwnResolution) {
  writeColor();
  writeGrey(16, {0, 1500, 65000});
  const auto read = readPair({.kind = InputKind::kSensor});
  EXPECT_TRUE(std::isnan(depthAt(read, 0, 0))) << "0 = nothing measured";
  EXPECT_NEAR(depthAt(read, 1, 0), 1.5, 1e-6);
  EXPECT_NEAR(depthAt(read, 2, 0), 65, 1e-4);
  const v1::Layer& layer = read.frame.wire.header.sources(0).layers(0);
  EXPECT_EQ(layer.planes(0).size().width(), 4U);
  EXPECT_EQ(layer.planes(1).size().width(), 3U);
  // A tenth of a millimetre instead.
  EXPECT_NEAR(depthAt(readPair({.kind = InputKind::kSensor, .depth_scale = 1e-4}), 1, 0), 0.15,
              1e-7);
  EXPECT_THAT(refusalOf({.kind = InputKind::kSensor}, {.color = file("color.png")}),
              HasSubstr("needs depth files. Give one with --depth"));
}

TEST_F(PictureInputsTest, readsOpenXrDepthForwardReversedAndInfinite) {
  writeColor();
  writeGrey(16, {0, 32768, 65535});
  const double middle = 32768.0 / 65535;
  const auto forward = readPair({.kind = InputKind::kOpenXr, .near_m = 0.5, .far_m = 8});
  EXPECT_NEAR(depthAt(forward, 0, 0), 0.5, 1e-6);
  EXPECT_NEAR(depthAt(forward, 1, 0), 1 / (2 + middle * (0.125 - 2)), 1e-5);
  EXPECT_NEAR(depthAt(forward, 2, 0), 8, 1e-4);
  const auto reversed = readPair({.kind = InputKind::kOpenXr, .near_m = kInfinity, .far_m = 0.5});
  EXPECT_EQ(depthAt(reversed, 0, 0), kInfinity);
  EXPECT_NEAR(depthAt(reversed, 1, 0), 0.5 / middle, 1e-5);
  EXPECT_NEAR(depthAt(reversed, 2, 0), 0.5, 1e-6);
  // Depth 0.2 .. 0.7 of the buffer: Z = (b - a) n f / ((b f - a n) - d (f - n)).
  const auto part = readPair(
      {.kind = InputKind::kOpenXr, .near_m = 0.5, .far_m = 8, .min_depth = 0.2, .max_depth = 0.7});
  EXPECT_NEAR(depthAt(part, 1, 0), 0.5 * 0.5 * 8 / ((0.7 * 8 - 0.2 * 0.5) - middle * (8 - 0.5)),
              1e-4);
  EXPECT_THAT(refusalOf({.kind = InputKind::kOpenXr, .near_m = 1},
                        {.color = file("color.png"), .depth = file("depth.png")}),
              HasSubstr("needs --depth-near and --depth-far"));
}

TEST_F(PictureInputsTest, readsPhonesAsDisparityOrBetweenTwoDistances) {
  writeColor();
  // 8 bits between 0.5 and 4 m: normalised disparity.
  writeGrey(8, {0, 51, 255});
  const auto codes = readPair({.kind = InputKind::kIphone, .near_m = 0.5, .far_m = 4});
  EXPECT_NEAR(depthAt(codes, 0, 0), 4, 1e-5);
  EXPECT_NEAR(depthAt(codes, 1, 0), 1 / (0.25 + 0.2 * 1.75), 1e-5);
  EXPECT_NEAR(depthAt(codes, 2, 0), 0.5, 1e-6);
  // Floats are 1/m as they are.
  writeExr(file("depth.exr"), 2, 1,
           {{"Z", Imf::HALF, [](int x, int) { return x == 0 ? 0.5F : 2.0F; }}});
  const auto floats = readInput({.kind = InputKind::kIphone},
                                {.color = file("color.png"), .depth = file("depth.exr")});
  EXPECT_NEAR(depthAt(floats, 0, 0), 2, 1e-6);
  EXPECT_NEAR(depthAt(floats, 1, 0), 0.5, 1e-6);
}

TEST_F(PictureInputsTest, stretchesRelativeDepthBetweenNearAndFar) {
  writeColor();
  writeExr(file("depth.exr"), 3, 1,
           {{"Z", Imf::FLOAT, [](int x, int) { return 10.0F + 20.0F * static_cast<float>(x); }}});
  inputs::InputReader reader({.kind = InputKind::kRelative, .near_m = 1, .far_m = 5});
  const inputs::InputFiles files{.color = file("color.png"), .depth = file("depth.exr")};
  auto first = reader.read(files);
  ASSERT_TRUE(first.ok()) << first.status();
  // 10, 30, 50 lie at 1/Z of 0.2, 0.6, 1.
  EXPECT_NEAR(depthAt(*first, 0, 0), 5, 1e-5);
  EXPECT_NEAR(depthAt(*first, 1, 0), 1 / 0.6, 1e-5);
  EXPECT_NEAR(depthAt(*first, 2, 0), 1, 1e-5);
  // The range of the first frame holds for later ones.
  writeExr(file("depth.exr"), 3, 1,
           {{"Z", Imf::FLOAT, [](int x, int) { return x == 1 ? 30.0F : 40.0F; }}});
  auto second = reader.read(files);
  ASSERT_TRUE(second.ok()) << second.status();
  EXPECT_NEAR(depthAt(*second, 1, 0), 1 / 0.6, 1e-5);
  EXPECT_NEAR(depthAt(*second, 0, 0), 1 / 0.8, 1e-5);
  // A scale and an offset of the user's instead.
  const auto scaled =
      readInput({.kind = InputKind::kRelative, .depth_scale = 0.01, .depth_offset = 0.1}, files);
  EXPECT_NEAR(depthAt(scaled, 1, 0), 1 / 0.4, 1e-5);
}

TEST_F(PictureInputsTest, refusesDistancesThatWouldNotCount) {
  writeColor();
  writeGrey(16, {1, 2, 3});
  const inputs::InputFiles files{.color = file("color.png"), .depth = file("depth.png")};
  EXPECT_THAT(refusalOf({.near_m = 1}, files),
              HasSubstr("--depth-near has no effect with --input plain"));
  EXPECT_THAT(refusalOf({.kind = InputKind::kSensor, .far_m = 9}, files),
              HasSubstr("has no effect with --input sensor"));
  EXPECT_THAT(
      refusalOf({.kind = InputKind::kRelative, .near_m = 1, .far_m = 2, .max_depth = 1}, files),
      HasSubstr("--depth-max has no effect"));
  EXPECT_EQ(refusalOf({.depth_meaning = v1::DEPTH_MEANING_WINDOW, .near_m = 1, .far_m = 2}, files),
            "OK");
}

TEST_F(PictureInputsTest, refusesRelativeDepthThatIsOneNumber) {
  writeColor();
  writeExr(file("depth.exr"), 2, 1, {{"Z", Imf::FLOAT, [](int, int) { return 3.0F; }}});
  EXPECT_THAT(refusalOf({.kind = InputKind::kRelative, .near_m = 1, .far_m = 5},
                        {.color = file("color.png"), .depth = file("depth.exr")}),
              HasSubstr("has the same value everywhere"));
}

}  // namespace
}  // namespace viewloom::test::picture_inputs_test
