// SPDX-License-Identifier: Apache-2.0
// Views that look past their source, beside what one eye after the other sees of a wall.
#include "display/views_outside.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace viewloom::views_outside_test {
namespace {

constexpr SizePx kSource_px{1000, 500};
const Intrinsics kSource{.focal_px = {800, 800}, .principal_px = {500, 250}};

// Eyes at these x, m, that all see 2 m x 1 m at 2 m. The source sees 2.5 m x 1.25 m there.
AtlasLayout layoutOf(const std::vector<double>& eyes_m) {
  AtlasLayout layout;
  layout.tile_size_px = {200, 100};
  for (const double x_m : eyes_m) {
    View view;
    view.camera.pose.position_m = {x_m, 0, 0};
    view.camera.intrinsics = {.focal_px = {200, 200}, .principal_px = {100 + 100 * x_m, 50}};
    layout.views.push_back(view);
  }
  return layout;
}

// The wall at z_m, from the eye through the edges of the frame, as the source sees it.
double shareOnWall(double eye_m, double z_m) {
  double most = -1;
  for (const double edge_m : {-1.0, 1.0}) {
    const double on_wall_m = eye_m + (edge_m - eye_m) * z_m / 2;
    most = std::max(most, std::abs(on_wall_m) / z_m * 800 - 500);
  }
  return most / 1000;
}

TEST(OutsideShares, areThoseOfTheWorseEndOfTheRange) {
  const std::vector<double> eyes_m{-1, -0.3, 0, 0.2, 0.7};
  const InvZRange range{.far = 1 / 6.0, .near = 1 / 1.5};
  const auto shares = outsideShares(layoutOf(eyes_m), {}, kSource, kSource_px, range);
  ASSERT_EQ(shares.size(), eyes_m.size());
  for (size_t i = 0; i < eyes_m.size(); ++i) {
    const double expected = std::max(shareOnWall(eyes_m[i], 6), shareOnWall(eyes_m[i], 1.5));
    if (expected > 0) {
      EXPECT_NEAR(shares[i], expected, 1e-12) << eyes_m[i];
    } else {
      EXPECT_LE(shares[i], 0) << eyes_m[i];
    }
  }
  EXPECT_GT(shares.front(), 0.05);
  EXPECT_LE(shares[2], 0);
}

TEST(OutsideShares, lookAtInfinityWhereTheSkyIs) {
  const auto shares = outsideShares(layoutOf({0.5}), {}, kSource, kSource_px, {});
  // Its left edge leaves the eye at a slope of (1 + 0.5) / 2.
  EXPECT_NEAR(shares.front(), (0.75 * 800 - 500) / 1000, 1e-12);
}

TEST(OutsideShares, areOfHeightToo) {
  AtlasLayout layout = layoutOf({0});
  layout.views[0].camera.pose.position_m.y = 0.5;
  const auto shares = outsideShares(layout, {}, kSource, kSource_px, {.far = 0.5, .near = 0.5});
  // From there the frame reaches from 0 to 1 m, of which the source sees 0.625 m.
  EXPECT_NEAR(shares.front(), (1 / 2.0 * 800 - 250) / 500, 1e-12);
}

TEST(OutsideShares, areNoneBelowHalfAPx) {
  for (const double past_px : {0.4, 0.6}) {
    AtlasLayout layout = layoutOf({0});
    const double tangent = (500 + past_px) / 800;
    layout.views[0].camera.intrinsics.focal_px.x = 100 / tangent;
    const auto shares = outsideShares(layout, {}, kSource, kSource_px, {.far = 0.5, .near = 0.5});
    if (past_px < kOutsideTolerance_px) {
      EXPECT_LE(shares.front(), 0);
    } else {
      EXPECT_NEAR(shares.front(), past_px / 1000, 1e-9);
    }
  }
}

TEST(OutsideShares, areAllOfTheImageForViewsThatLookBack) {
  AtlasLayout layout = layoutOf({0});
  layout.views[0].camera.pose.orientation = glm::angleAxis(M_PI, glm::dvec3(0, 1, 0));
  EXPECT_EQ(outsideShares(layout, {}, kSource, kSource_px, {.far = 0, .near = 1}),
            std::vector<double>{1});
}

TEST(OutsideShares, moveWithTheDisplay) {
  const Pose aside{.position_m = {0.5, 0, 0}};
  const auto moved =
      outsideShares(layoutOf({0}), aside, kSource, kSource_px, {.far = 0.5, .near = 0.5});
  // The frame's right edge at 1.5 m, of which the source sees 1.25.
  EXPECT_NEAR(moved.front(), (1.5 / 2 * 800 - 500) / 1000, 1e-12);
}

TEST(OutsideShares, ofAPanelAreThoseOfItsOutermostEyes) {
  AtlasLayout layout = layoutOf({0});
  layout.size_px = layout.tile_size_px;
  layout.eye_focus_m = 2;
  layout.rays = LenticularRays{.view_cone_rad = 0.6, .distance_m = 2};
  const auto shares = outsideShares(layout, {}, kSource, kSource_px, {});
  ASSERT_EQ(shares.size(), 1U);
  // Half a px of the panel of 1 cm more on the outside, for samples anywhere in it.
  EXPECT_NEAR(shares.front(), ((1 + 0.005) / 2 * 800 + std::tan(0.3) * 800 - 500) / 1000, 1e-9);
}

TEST(ViewsOutside, areRunsOfNeighbours) {
  const std::vector<double> shares{0.04, 0.02, -0.1, 0, 0.01, 0.3, -1, 0.2};
  const std::vector<ViewsOutside> expected{{0, 1, 0.04}, {4, 5, 0.3}, {7, 7, 0.2}};
  EXPECT_EQ(viewsOutside(shares), expected);
  EXPECT_TRUE(viewsOutside(std::vector<double>{-0.1, 0}).empty());
  EXPECT_TRUE(viewsOutside({}).empty());
}

TEST(SettledShares, areHundredthsRoundedUp) {
  SettledShares settled;
  const auto runs = settled.settle(std::vector<double>{0.0301, -0.2, 0.001});
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_DOUBLE_EQ(runs[0].share, 0.04);
  EXPECT_DOUBLE_EQ(runs[1].share, 0.01);
}

TEST(SettledShares, stayWhileDepthTrembles) {
  std::mt19937 random(3);
  std::normal_distribution<double> tremble(0, 0.001);
  SettledShares settled;
  size_t changes = 0;
  std::vector<ViewsOutside> before;
  // On the edges of hundredths and of the image, where rounding alone would flicker.
  for (int frame = 0; frame < 2000; ++frame) {
    std::vector<double> shares{0.04, 0.03, 0.0, -0.1, 0.0005};
    for (double& share : shares) share += tremble(random);
    const auto runs = settled.settle(shares);
    changes += runs != before;
    before = runs;
  }
  EXPECT_LE(changes, 5U);
}

TEST(SettledShares, followWhatTrulyChanges) {
  SettledShares settled;
  EXPECT_DOUBLE_EQ(settled.settle(std::vector<double>{0.035}).front().share, 0.04);
  EXPECT_DOUBLE_EQ(settled.settle(std::vector<double>{0.060}).front().share, 0.06);
  EXPECT_DOUBLE_EQ(settled.settle(std::vector<double>{0.015}).front().share, 0.02);
  EXPECT_TRUE(settled.settle(std::vector<double>{-0.02}).empty());
}

}  // namespace
}  // namespace viewloom::views_outside_test
