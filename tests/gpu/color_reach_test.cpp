// SPDX-License-Identifier: Apache-2.0
// How far colour is averaged for views of given px (shaders/color.md, Means).
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "picture/trace_job.h"

namespace viewloom::color_reach_test {
namespace {

abi::ViewParams tileOf(const abi::vec3& step_x, const abi::vec3& step_y) {
  return {.eye = abi::vec3(0),
          .direction = {0, 0, 1},
          .direction_dx = step_x,
          .direction_dy = step_y,
          .is_used = 1};
}

constexpr SizePx kTile_px{8, 8};

TEST(ColorReach, turnsWithTheView) {
  const abi::ViewParams turned = tileOf({0, 4.6F, 0}, {-2.4F, 0, 0});
  const ColorReach reach = colorReach(std::span(&turned, 1), kTile_px);
  EXPECT_FLOAT_EQ(reach.x_px, 0.5F);
  EXPECT_FLOAT_EQ(reach.y_px, 1.6F);
  // Halfway, each side of a px of 2 px goes along both axes.
  const float side = std::sqrt(2.0F);
  const abi::ViewParams half_turned = tileOf({side, side, 0}, {-side, side, 0});
  const ColorReach both = colorReach(std::span(&half_turned, 1), kTile_px);
  EXPECT_NEAR(both.x_px, 0.3, 1e-6);
  EXPECT_NEAR(both.y_px, 0.3, 1e-6);
}

TEST(ColorReach, isThatOfTheSmallestPixelsAndBounded) {
  std::vector<abi::ViewParams> tiles = {tileOf({3.4F, 0, 0}, {0, 30, 0}),
                                        tileOf({5, 0, 0}, {0, 40, 0}), abi::ViewParams{}};
  const ColorReach reach = colorReach(tiles, kTile_px);
  EXPECT_FLOAT_EQ(reach.x_px, 1);
  EXPECT_EQ(reach.y_px, abi::kColorReachMax_px);
  tiles.push_back(tileOf({1.4F, 0, 0}, {0, 1, 0}));
  EXPECT_TRUE(colorReach(tiles, kTile_px).isNone());
  EXPECT_TRUE(colorReach({}, kTile_px).isNone());
}

}  // namespace
}  // namespace viewloom::color_reach_test
