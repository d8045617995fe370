// SPDX-License-Identifier: Apache-2.0
// Depth of data sets and sensors, packed depth and upside-down files, against distances worked out
// by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "unit/inputs/written_pair.h"

namespace viewloom::test::sensor_inputs_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class SensorInputsTest : public WrittenPairTest {
 protected:
  inputs::InputFiles pair(const std::string& depth) const {
    writeColor();
    return {.color = file("color.png"), .depth = file(depth)};
  }
  inputs::ReadInput readCodes(const InputSettings& settings, uint32_t bits,
                              const std::vector<uint16_t>& codes, uint32_t width_px) const {
    const auto height_px = static_cast<uint32_t>(codes.size()) / width_px;
    writePng(file("depth.png"), width_px, height_px, 1, bits, codes);
    return readInput(settings, pair("depth.png"));
  }
  inputs::ReadInput readColors(const InputSettings& settings,
                               const std::vector<uint16_t>& rgb) const {
    writePng(file("depth.png"), static_cast<uint32_t>(rgb.size() / 3), 1, 3, 8, rgb);
    return readInput(settings, pair("depth.png"));
  }
};

TEST_F(SensorInputsTest, knowsTheUnitsOfDataSetsAndSensors) {
  const auto depthOf = [&](InputKind kind) {
    const auto read = readCodes({.kind = kind}, 16, {0, 10000}, 2);
    EXPECT_TRUE(std::isnan(depthAt(read, 0, 0))) << "0 is nothing measured";
    return depthAt(read, 1, 0);
  };
  EXPECT_NEAR(depthOf(InputKind::kKitti), 39.0625, 1e-4);
  EXPECT_NEAR(depthOf(InputKind::kTum), 2, 1e-6);
  EXPECT_NEAR(depthOf(InputKind::kL515), 2.5, 1e-6);
  EXPECT_NEAR(depthOf(InputKind::kD405), 1, 1e-6);
  EXPECT_NEAR(depthOf(InputKind::kRecord3d), 10, 1e-5);
  EXPECT_NEAR(depthOf(InputKind::kSensor), 10, 1e-5);
}

TEST_F(SensorInputsTest, takesRecord3dsFloatsForMetres) {
  std::ofstream(file("depth.pfm"), std::ios::binary) << "Pf 2 1 -1\n"
                                                     << std::string("\0\0\0\0\0\0\x20\x40", 8);
  const auto read = readInput({.kind = InputKind::kRecord3d}, pair("depth.pfm"));
  EXPECT_TRUE(std::isnan(depthAt(read, 0, 0)));
  EXPECT_NEAR(depthAt(read, 1, 0), 2.5, 1e-6);
}

TEST_F(SensorInputsTest, turnsDisparityInPxIntoDepthByBaselineAndFocalLength) {
  // 0.54 m x 720 px / (10000 / 256 px) = 9.953 m.
  const InputSettings kitti{.kind = InputKind::kKitti, .baseline_m = 0.54, .focal_px = 720};
  const auto read = readCodes(kitti, 16, {0, 10000}, 2);
  EXPECT_NEAR(depthAt(read, 1, 0), 0.54 * 720 * 256 / 10000, 1e-4);
  EXPECT_TRUE(std::isnan(depthAt(read, 0, 0)));
  // Middlebury: 1/Z = (d + offset) / (f b).
  const InputSettings stereo{.depth_meaning = v1::DEPTH_MEANING_DISPARITY,
                             .depth_offset = 100,
                             .baseline_m = 0.2,
                             .focal_px = 4000};
  EXPECT_NEAR(depthAt(readCodes(stereo, 16, {0, 300}, 2), 1, 0), 2, 1e-5);
  InputSettings blind = kitti;
  blind.focal_px.reset();
  EXPECT_THAT(refusalOf(blind, pair("depth.png")), HasSubstr("needs the focal length"));
  EXPECT_THAT(refusalOf({.baseline_m = 0.5, .focal_px = 700}, pair("depth.png")),
              HasSubstr("give --input kitti or --depth-meaning disparity"));
}

TEST_F(SensorInputsTest, takesScatteredZerosOfDisparityForNothingAndSaysSo) {
  const InputSettings plain{.depth_meaning = v1::DEPTH_MEANING_DISPARITY, .depth_scale = 0.001};
  std::mt19937 random(5);
  std::vector<uint16_t> sparse(64 * 32), sky(64 * 32, 500);
  for (uint16_t& code : sparse) code = random() % 5 == 0 ? 500 : 0;
  std::fill_n(sky.begin(), 64 * 12, uint16_t{0});
  const auto scattered = readCodes(plain, 16, sparse, 64);
  EXPECT_THAT(scattered.how.notes, Contains(HasSubstr("0, scattered over")));
  const auto isNothing = [&](const inputs::ReadInput& read, uint32_t i) {
    return std::isnan(depthAt(read, i % 64, i / 64));
  };
  for (uint32_t i = 0; i < sparse.size(); ++i) {
    ASSERT_EQ(isNothing(scattered, i), sparse[i] == 0) << i;
  }
  const auto above = readCodes(plain, 16, sky, 64);
  EXPECT_TRUE(std::isinf(depthAt(above, 3, 3))) << "an area of 0 is a sky";
  EXPECT_THAT(above.how.notes, Not(Contains(HasSubstr("scattered"))));
  InputSettings far = plain;
  far.depth_far_zero = true;
  const auto told = readCodes(far, 16, sparse, 64);
  EXPECT_THAT(told.how.notes, Not(Contains(HasSubstr("scattered"))));
  for (uint32_t i = 0; i < sparse.size(); ++i) {
    ASSERT_EQ(std::isinf(depthAt(told, i % 64, i / 64)), sparse[i] == 0) << i;
  }
}

TEST_F(SensorInputsTest, unpacksDepthOfColourChannels) {
  // CARLA: (R + 256 G + 65536 B) / (256^3 - 1) x 1000 m. 4 m is code 67109 = 0x010625.
  const auto carla = readColors({.depth_packing = v1::DEPTH_PACKING_RGB24}, {0x25, 0x06, 0x01});
  EXPECT_NEAR(depthAt(carla, 0, 0), 4, 1e-4);
  EXPECT_THAT(carla.how.notes, Contains(HasSubstr("white is 1000 m")));
  const auto turned = readColors({.depth_scale = 100, .depth_packing = v1::DEPTH_PACKING_BGR24},
                                 {0x01, 0x06, 0x25});
  EXPECT_NEAR(depthAt(turned, 0, 0), 0.4, 1e-5);
  // 16 bits in millimetres.
  const InputSettings millimetres{.depth_scale = 65.535, .depth_packing = v1::DEPTH_PACKING_RG16};
  EXPECT_NEAR(depthAt(readColors(millimetres, {0x05, 0xDC, 0}), 0, 0), 1.5, 1e-5);
  const InputSettings sensor{.kind = InputKind::kSensor, .depth_packing = v1::DEPTH_PACKING_RG16};
  EXPECT_NEAR(depthAt(readColors(sensor, {0x05, 0xDC, 0}), 0, 0), 1.5, 1e-5);
  // Window depth, as a shader packs it: 0.5 between 1 and 3 m is 1 / (1 - 0.5 x (2 / 3)).
  const InputSettings window{.depth_meaning = v1::DEPTH_MEANING_WINDOW,
                             .near_m = 1,
                             .far_m = 3,
                             .depth_packing = v1::DEPTH_PACKING_BGR24};
  EXPECT_NEAR(depthAt(readColors(window, {0x80, 0, 0}), 0, 0), 1.5, 1e-4);
}

TEST_F(SensorInputsTest, readsTheHuesOfRealSense) {
  // Red is the near end, green a third of 1530 codes further; black is nothing.
  const InputSettings settings{.near_m = 0.3, .far_m = 4, .depth_packing = v1::DEPTH_PACKING_HUE};
  const auto read = readColors(settings, {255, 0, 0, 0, 255, 0, 0, 0, 0});
  EXPECT_NEAR(depthAt(read, 0, 0), 0.3, 1e-4);
  EXPECT_NEAR(depthAt(read, 1, 0), 0.3 + 3.7 * 510 / 1529, 1e-3);
  EXPECT_TRUE(std::isnan(depthAt(read, 2, 0)));
  InputSettings disparity = settings;
  disparity.depth_meaning = v1::DEPTH_MEANING_DISPARITY;
  EXPECT_NEAR(depthAt(readColors(disparity, {255, 0, 0}), 0, 0), 4, 1e-3);
  InputSettings open = settings;
  open.near_m.reset();
  EXPECT_THAT(refusalOf(open, pair("depth.png")), HasSubstr("needs --depth-near and --depth-far"));
}

TEST_F(SensorInputsTest, namesThePackingThatAColouredDepthLooksLike) {
  std::vector<uint16_t> rgb, bgr;
  for (uint16_t i = 0; i < 64; ++i) {
    const uint32_t code = 67109 + 97U * i;
    const auto low = uint16_t(code & 255), middle = uint16_t(code >> 8 & 255);
    rgb.insert(rgb.end(), {low, middle, uint16_t(code >> 16)});
    bgr.insert(bgr.end(), {uint16_t(code >> 16), middle, low});
  }
  writePng(file("depth.png"), 64, 1, 3, 8, rgb);
  EXPECT_THAT(refusalOf({}, pair("depth.png")),
              HasSubstr("give --depth-packing rgb24 (CARLA: white is 1000 m"));
  writePng(file("depth.png"), 64, 1, 3, 8, bgr);
  EXPECT_THAT(refusalOf({}, pair("depth.png")), HasSubstr("give --depth-packing bgr24"));
}

TEST_F(SensorInputsTest, flipsRowsOfDepthAndColour) {
  const auto read =
      readCodes({.kind = InputKind::kSensor, .flips_depth = true}, 16, {1000, 2000, 3000, 4000}, 2);
  EXPECT_NEAR(depthAt(read, 0, 0), 3, 1e-6);
  EXPECT_NEAR(depthAt(read, 1, 1), 2, 1e-6);
  std::vector<uint16_t> colors(12, 9);
  colors[0] = 200;
  writePng(file("up.png"), 1, 4, 3, 8, colors);
  writePng(file("depth.png"), 1, 4, 1, 16, {1, 2, 3, 4});
  const auto color = readInput({.kind = InputKind::kSensor, .flips_color = true},
                               {.color = file("up.png"), .depth = file("depth.png")});
  EXPECT_EQ((*color.frame.wire.planes[0])[9], 200);
}

TEST_F(SensorInputsTest, takesTheCodeOfWhiteThatIsGiven) {
  // Photoshop's 15 bits: 32768 is white.
  const InputSettings relative{
      .kind = InputKind::kRelative, .near_m = 1, .far_m = 4, .white_code = 32768};
  const auto read = readCodes(relative, 16, {0, 16384, 32768}, 3);
  EXPECT_NEAR(depthAt(read, 0, 0), 4, 1e-4);
  EXPECT_NEAR(depthAt(read, 1, 0), 1.6, 1e-4);
  EXPECT_NEAR(depthAt(read, 2, 0), 1, 1e-5);
  const InputSettings window{
      .kind = InputKind::kOpenXr, .near_m = 1, .far_m = 4, .white_code = 32768};
  EXPECT_NEAR(depthAt(readCodes(window, 16, {0, 32768}, 2), 1, 0), 4, 1e-4);
}

}  // namespace
}  // namespace viewloom::test::sensor_inputs_test
