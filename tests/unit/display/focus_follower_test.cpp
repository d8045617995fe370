// SPDX-License-Identifier: Apache-2.0
#include "display/focus_follower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "display/depth_budget.h"

namespace viewloom::focus_follower_test {
namespace {

constexpr int64_t kSecond_ns = 1'000'000'000;

// Views of 100 px focal length, `pitch_m` apart: disparity is 100 * pitch_m px for each 1/m.
AtlasLayout layoutAt(double focal_distance_m, double pitch_m = 1) {
  AtlasLayout layout;
  layout.focal_distance_m = focal_distance_m;
  layout.eye_focus_m = focal_distance_m;
  layout.view_pitch_m = {pitch_m, 0};
  layout.views.push_back({Camera{.intrinsics = {{100, 100}, {50, 50}}}});
  return layout;
}

TEST(FocusFollower, beginsWhereTheDisplayHasItsFocalPlane) {
  FocusFollower follower;
  EXPECT_FALSE(follower.follow(layoutAt(2), 10, 1, 5 * kSecond_ns).has_value());
  // No time has passed.
  EXPECT_FALSE(follower.follow(layoutAt(2), 10, 1, 5 * kSecond_ns).has_value());
}

TEST(FocusFollower, goesAShareOfItsWayInOneOverZThatTheTimeSays) {
  for (const double time_constant_s : {0.5, 2.0}) {
    FocusFollower follower;
    double focal_m = 2;
    follower.follow(layoutAt(focal_m), 10, time_constant_s, 0);
    // Several steps of any length end where one step would.
    for (const double time_s : {0.1, 0.15, 0.9, 2.0}) {
      const auto moved =
          follower.follow(layoutAt(focal_m), 10, time_constant_s, int64_t(time_s * 1e9));
      ASSERT_TRUE(moved.has_value());
      focal_m = *moved;
      const double left = std::exp(-time_s / time_constant_s);
      EXPECT_NEAR(1 / focal_m, 0.1 + (0.5 - 0.1) * left, 1e-9);
    }
  }
}

TEST(FocusFollower, takesAJumpAsItTakesADrift) {
  FocusFollower follower;
  follower.follow(layoutAt(1), 1, 1, 0);
  const auto jumped = follower.follow(layoutAt(1), 1e9, 1, kSecond_ns);
  ASSERT_TRUE(jumped.has_value());
  EXPECT_NEAR(1 / *jumped, std::exp(-1.0), 1e-8);
}

TEST(FocusFollower, staysWhileNobodyWouldSeeItMove) {
  FocusFollower follower;
  const AtlasLayout layout = layoutAt(2, 0.01);  // a px for each 1/m
  ASSERT_EQ(disparityPerInvZ(layout), 1);
  follower.follow(layout, 2, 1, 0);
  const double near_m = 1 / (0.5 + 0.04);
  EXPECT_FALSE(follower.follow(layout, near_m, 1, 100 * kSecond_ns).has_value());
  // Movement that was too small to show is not lost.
  const double nearer_m = 1 / (0.5 + 0.06);
  EXPECT_FALSE(follower.follow(layout, nearer_m, 1e9, 101 * kSecond_ns).has_value());
  const auto moved = follower.follow(layout, nearer_m, 1, 101 * kSecond_ns + kSecond_ns);
  ASSERT_TRUE(moved.has_value());
  EXPECT_NEAR(1 / *moved, 0.56 - 0.02 * std::exp(-1.0), 1e-9);
}

TEST(FocusFollower, standsStillWhileTheClockGoesBack) {
  FocusFollower follower;
  follower.follow(layoutAt(2), 1, 1, 10 * kSecond_ns);
  EXPECT_FALSE(follower.follow(layoutAt(2), 1, 1, 3 * kSecond_ns).has_value());
  const auto moved = follower.follow(layoutAt(2), 1, 1, 4 * kSecond_ns);
  ASSERT_TRUE(moved.has_value());
  EXPECT_NEAR(1 / *moved, 1 - 0.5 * std::exp(-1.0), 1e-9);
}

TEST(FocusFollowing, isForDisplaysWhoseViewsFrameAPlaneOfTheirOwn) {
  const auto problemOf = [](DisplaySpec spec, double following_s) {
    spec.focus_following_s = following_s;
    return fieldOf(completeDisplaySpec(spec).status());
  };
  const std::string field = "focus_following_s";
  const QuiltSpec quilt{.columns = 2, .rows = 2, .size_px = {64, 64}};
  StereoSpec stereo{.eye_size_px = {8, 8}};
  const CameraGrid grid{.columns = 2, .rows = 2};
  for (const DisplaySpec& spec :
       {DisplaySpec{.kind = quilt}, DisplaySpec{.kind = stereo},
        DisplaySpec{.kind = CamerasSpec{.grid = grid, .tile_size_px = {8, 8}}},
        DisplaySpec{.kind = LenticularSpec{.preset = "portrait"}}}) {
    EXPECT_EQ(problemOf(spec, 0.01), "");
    EXPECT_EQ(problemOf(spec, 60), "");
    EXPECT_EQ(problemOf(spec, 0.009), field);
    EXPECT_EQ(problemOf(spec, 61), field);
    EXPECT_EQ(problemOf(spec, -1), field);
    EXPECT_EQ(problemOf(spec, std::numeric_limits<double>::quiet_NaN()), field);
    const auto moved = withFocalDistance(*completeDisplaySpec(spec), 7);
    ASSERT_TRUE(moved.has_value());
    const StreamDefaults stream{.source_intrinsics = {{50, 50}, {32, 32}},
                                .source_size_px = {64, 64}};
    EXPECT_EQ(makeAtlasLayout(*moved, stream)->focal_distance_m, 7);
  }
  const ViewCamera camera{.projection = Intrinsics{{80, 80}, {50, 50}}};
  StereoSpec tracked = stereo;
  tracked.is_tracked = true;
  stereo.eyes.resize(2, camera);
  for (const DisplaySpec& spec :
       {DisplaySpec{.kind = stereo}, DisplaySpec{.kind = tracked},
        DisplaySpec{.kind = CamerasSpec{.cameras = {camera}, .tile_size_px = {8, 8}}},
        DisplaySpec{.kind = IntegralSpec{.preset = "near_eye_2013"}}}) {
    EXPECT_EQ(problemOf(spec, 0), "");
    EXPECT_EQ(problemOf(spec, 1), field);
  }
}

}  // namespace
}  // namespace viewloom::focus_follower_test
