// SPDX-License-Identifier: Apache-2.0
// Choices where the user gives none: distances, white, zeros, and surfaces too far away.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "unit/inputs/written_pair.h"

namespace viewloom::test::chosen_depth_test {
namespace {

using ::testing::HasSubstr;

class ChosenDepthTest : public WrittenPairTest {};

// 1/Z of 0.5 .. 1.5 1/m, or with the same ratio to the distance that is given.
TEST_F(ChosenDepthTest, choosesDistancesForDepthOfUnknownScale) {
  // Two px of colour, two of depth: black and white.
  writePng(file("rgbd.png"), 4, 1, 1, 8, {90, 90, 0, 255});
  const auto halves = readInput({.kind = InputKind::kRgbd}, {.color = file("rgbd.png")});
  EXPECT_NEAR(depthAt(halves, 0, 0), 2, 1e-5);
  EXPECT_NEAR(depthAt(halves, 1, 0), 2.0 / 3, 1e-5);
  EXPECT_THAT(halves.how.notes, testing::Contains(HasSubstr("between 0.666667 and 2 m")));
  writeColor();
  writeGrey(16, {0, 32768, 65535});
  const auto relative = readPair({.kind = InputKind::kRelative});
  EXPECT_NEAR(depthAt(relative, 0, 0), 2, 1e-5);
  EXPECT_NEAR(depthAt(relative, 1, 0), 1, 1e-4);
  const auto near = readPair({.kind = InputKind::kRelative, .near_m = 2});
  EXPECT_NEAR(depthAt(near, 0, 0), 6, 1e-4);
  const auto far = readPair({.kind = InputKind::kRelative, .far_m = 9});
  EXPECT_NEAR(depthAt(far, 2, 0), 3, 1e-4);
  const auto sky = readPair({.kind = InputKind::kRelative, .far_m = kInfinity});
  EXPECT_EQ(depthAt(sky, 0, 0), kInfinity);
  EXPECT_NEAR(depthAt(sky, 2, 0), 2.0 / 3, 1e-5);
  const auto stated = readPair({.kind = InputKind::kRelative, .near_m = 1, .far_m = 4});
  EXPECT_THAT(stated.how.notes, testing::IsEmpty());
}

TEST_F(ChosenDepthTest, takesTheCodeOfWhite) {
  writeColor();
  writeGrey(16, {0, 16384, 32768});
  InputSettings settings{.kind = InputKind::kRelative, .near_m = 1, .far_m = 2};
  settings.white_code = 32768;
  const auto read = readPair(settings);
  EXPECT_NEAR(depthAt(read, 0, 0), 2, 1e-5);
  EXPECT_NEAR(depthAt(read, 1, 0), 1 / 0.75, 1e-5);
  EXPECT_NEAR(depthAt(read, 2, 0), 1, 1e-5);
  EXPECT_THAT(refusalOf({.kind = InputKind::kSensor, .white_code = 4095},
                        {.color = file("color.png"), .depth = file("depth.png")}),
              HasSubstr("--depth-white has no effect with --input sensor"));
}

TEST_F(ChosenDepthTest, cutsWhatIsTooFar) {
  writeColor();
  writeExr(file("depth.exr"), 4, 1,
           {{"Z", Imf::FLOAT, [](int x, int) {
               const float depths_m[4] = {2, 4, 6e29F, std::numeric_limits<float>::infinity()};
               return depths_m[x];
             }}});
  InputSettings settings;
  settings.no_surface_beyond_m = 3;
  const inputs::InputFiles files{.color = file("color.png"), .depth = file("depth.exr")};
  const auto near = readInput(settings, files);
  EXPECT_NEAR(depthAt(near, 0, 0), 2, 1e-6);
  for (const uint32_t x : {1U, 2U, 3U}) EXPECT_TRUE(std::isnan(depthAt(near, x, 0))) << x;
  settings.no_surface_beyond_m = 1000;
  const auto far = readInput(settings, files);
  EXPECT_NEAR(depthAt(far, 1, 0), 4, 1e-6);
  EXPECT_TRUE(std::isnan(depthAt(far, 2, 0)));
  // Whole numbers, with a number without surface of their own.
  writeGrey(16, {0, 1500, 65000});
  const auto sensor = readPair({.kind = InputKind::kSensor, .no_surface_beyond_m = 20});
  EXPECT_TRUE(std::isnan(depthAt(sensor, 0, 0)));
  EXPECT_NEAR(depthAt(sensor, 1, 0), 1.5, 1e-6);
  EXPECT_TRUE(std::isnan(depthAt(sensor, 2, 0)));
  settings.no_surface_beyond_m = -1;
  EXPECT_THAT(refusalOf(settings, files), HasSubstr("--no-surface-beyond is -1; accepted are"));
}

// A tenth of the px was measured, in a grid; 0 is nothing there, but a sky where it lies together.
TEST_F(ChosenDepthTest, takesScatteredZerosOfDisparityForNoSurface) {
  constexpr uint32_t kSide = 40;
  writePng(file("color.png"), kSide, kSide, 3, 8, std::vector<uint16_t>(3 * kSide * kSide, 9));
  std::vector<uint16_t> sparse, below_sky;
  for (uint32_t y = 0; y < kSide; ++y) {
    for (uint32_t x = 0; x < kSide; ++x) {
      sparse.push_back(x % 3 == 0 && y % 3 == 0 ? uint16_t(500 + y) : 0);
      below_sky.push_back(y < 15 ? 0 : uint16_t(500 + y));
    }
  }
  const inputs::InputFiles files{.color = file("color.png"), .depth = file("depth.png")};
  InputSettings settings{.depth_meaning = v1::DEPTH_MEANING_DISPARITY, .depth_scale = 0.001};
  writePng(file("depth.png"), kSide, kSide, 1, 16, sparse);
  const auto scattered = readInput(settings, files);
  EXPECT_TRUE(std::isnan(depthAt(scattered, 1, 0)));
  EXPECT_NEAR(depthAt(scattered, 3, 0), 2, 1e-5);
  EXPECT_THAT(scattered.how.notes, testing::Contains(HasSubstr("0 is read as no surface")));
  settings.depth_far_zero = true;
  EXPECT_EQ(depthAt(readInput(settings, files), 1, 0), kInfinity) << "as it is told";
  settings.depth_far_zero = false;
  writePng(file("depth.png"), kSide, kSide, 1, 16, below_sky);
  EXPECT_EQ(depthAt(readInput(settings, files), 1, 0), kInfinity) << "a sky";
  settings.depth_invalid = 0;
  EXPECT_TRUE(std::isnan(depthAt(readInput(settings, files), 1, 0))) << "as it is told";
}

}  // namespace
}  // namespace viewloom::test::chosen_depth_test
