// SPDX-License-Identifier: Apache-2.0
// Depth budgets, judged by projecting every px of a small depth plane through neighbouring views.
#include "display/depth_budget.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "unit/display/axis_point.h"

namespace viewloom::depth_budget_test {
namespace {

// Two thirds of the px on things about 2 m away, the others on a slope from 3 m to 40 m.
std::vector<double> depthPlane() {
  std::mt19937 random(7);
  std::normal_distribution<double> near_m(2, 0.1);
  std::uniform_real_distribution<double> far_inv_z(1.0 / 40, 1.0 / 3);
  std::vector<double> z_m;
  for (int px = 0; px < 64 * 48; ++px) {
    z_m.push_back(px % 3 == 0 ? 1 / far_inv_z(random) : near_m(random));
  }
  return z_m;
}

// Bins of so many to an octave of 1/Z.
DepthSpread spreadOf(const std::vector<double>& z_m, double bins_per_octave) {
  std::vector<int> bins;
  for (const double z : z_m) bins.push_back(int(std::floor(-std::log2(z) * bins_per_octave)));
  std::sort(bins.begin(), bins.end());
  DepthSpread spread;
  for (size_t i = 0; i < bins.size(); ++i) {
    if (i == 0 || bins[i] != bins[i - 1]) {
      spread.push_back({.inv_z_low = std::exp2(bins[i] / bins_per_octave),
                        .inv_z_high = std::exp2((bins[i] + 1) / bins_per_octave)});
    }
    ++spread.back().count;
  }
  return spread;
}

SourceStats statsOf(const std::vector<double>& z_m) {
  const auto [near_m, far_m] = std::minmax_element(z_m.begin(), z_m.end());
  return {.inv_z_min = 1 / *far_m, .inv_z_max = 1 / *near_m};
}

AtlasLayout layoutOf(const DisplaySpec& spec) {
  const absl::StatusOr<DisplaySpec> completed = completeDisplaySpec(spec);
  EXPECT_TRUE(completed.ok()) << completed.status();
  const StreamDefaults stream{
      .source_intrinsics = {.focal_px = {900, 900}, .principal_px = {640, 360}},
      .source_size_px = {1280, 720},
      .focal_distance_m = 2.5};
  const absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(*completed, stream);
  EXPECT_TRUE(layout.ok()) << layout.status();
  return *layout;
}

// Eyes of the Bridge convention stand evenly.
QuiltSpec evenQuilt(double focal_distance_m, double view_cone_rad) {
  return {.columns = 8,
          .rows = 1,
          .size_px = {8 * 640, 360},
          .view_cone_rad = view_cone_rad,
          .focal_distance_m = focal_distance_m,
          .convention = CameraConvention::kBridge};
}

// How far the image of each px's surface moves between two views, by a textbook pinhole.
std::vector<double> disparities(const AtlasLayout& layout, size_t a, size_t b,
                                const std::vector<double>& z_m) {
  const Camera& from = layout.views[a].camera;
  const Camera& to = layout.views[b].camera;
  std::vector<double> moved_px;
  for (const double z : z_m) moved_px.push_back(axisPointStep_px(from, to, z));
  return moved_px;
}

double shareAbove(const std::vector<double>& values, double limit) {
  const auto count =
      std::count_if(values.begin(), values.end(), [limit](double value) { return value > limit; });
  return double(count) / double(values.size());
}

TEST(DepthBudget, countsThePxThatMoveTooFar) {
  const std::vector<double> z_m = depthPlane();
  const AtlasLayout layout = layoutOf({.kind = evenQuilt(2.5, 0.4)});
  const std::vector<double> moved_px = disparities(layout, 3, 4, z_m);
  const auto budget = depthBudget(layout, statsOf(z_m), spreadOf(z_m, 1e7));
  ASSERT_TRUE(budget);
  EXPECT_NEAR(budget->disparity_max_px, *std::max_element(moved_px.begin(), moved_px.end()), 1e-6);
  EXPECT_GT(budget->beyond_ghosting_share, 0.05) << "there is something to count";
  EXPECT_LT(budget->beyond_fusing_share, 0.95);
  EXPECT_DOUBLE_EQ(budget->beyond_fusing_share, shareAbove(moved_px, 5));
  EXPECT_DOUBLE_EQ(budget->beyond_ghosting_share, shareAbove(moved_px, 8));
}

// The bins of the server: those at the limits hold this share of the px together, at most.
TEST(DepthBudget, countsToHalfABinOfA32thOctave) {
  const std::vector<double> z_m = depthPlane();
  const AtlasLayout layout = layoutOf({.kind = evenQuilt(2.5, 0.4)});
  const std::vector<double> moved_px = disparities(layout, 3, 4, z_m);
  const auto budget = depthBudget(layout, statsOf(z_m), spreadOf(z_m, 32));
  ASSERT_TRUE(budget);
  EXPECT_NEAR(budget->beyond_fusing_share, shareAbove(moved_px, 5), 0.02);
  EXPECT_NEAR(budget->beyond_ghosting_share, shareAbove(moved_px, 8), 0.02);
}

TEST(DepthBudget, suggestsWhatLets98PercentFuse) {
  const std::vector<double> z_m = depthPlane();
  const auto budget =
      depthBudget(layoutOf({.kind = evenQuilt(2.5, 0.7)}), statsOf(z_m), spreadOf(z_m, 32));
  ASSERT_TRUE(budget);
  EXPECT_GT(budget->beyond_fusing_share, 0.2);
  const auto shareWith = [&](double focal_distance_m, double view_cone_rad) {
    const AtlasLayout layout = layoutOf({.kind = evenQuilt(focal_distance_m, view_cone_rad)});
    return shareAbove(disparities(layout, 3, 4, z_m), 5);
  };
  const double focal_distance_m = budget->suggested_focal_distance_m;
  const double view_cone_rad = budget->suggested_view_cone_rad;
  EXPECT_LE(shareWith(focal_distance_m, view_cone_rad), 0.02);
  EXPECT_GT(shareWith(focal_distance_m, 1.3 * view_cone_rad), 0.02) << "no narrower than it must";
  EXPECT_GT(shareWith(1.25 * focal_distance_m, view_cone_rad), 0.02);
}

TEST(DepthBudget, neverSuggestsMoreThanTheDisplayHas) {
  const std::vector<double> flat_m(100, 3.0);
  const auto budget =
      depthBudget(layoutOf({.kind = evenQuilt(3, 0.4)}), statsOf(flat_m), spreadOf(flat_m, 1e6));
  ASSERT_TRUE(budget);
  EXPECT_EQ(budget->suggested_view_cone_rad, 0.4);
  EXPECT_NEAR(budget->suggested_focal_distance_m, 3, 1e-5);
  EXPECT_EQ(budget->beyond_fusing_share, 0);
  EXPECT_NEAR(budget->disparity_max_px, 0, 1e-9);
}

TEST(DepthBudget, suggestsAFlatThingsOwnDistanceWhereverItsBinLies) {
  const AtlasLayout layout = layoutOf({.kind = evenQuilt(3, 0.4)});
  for (const double z_m : {3.0, 3.03, 3.06}) {
    const std::vector<double> flat_m(100, z_m);
    const auto budget = depthBudget(layout, statsOf(flat_m), spreadOf(flat_m, 32));
    ASSERT_TRUE(budget);
    EXPECT_DOUBLE_EQ(budget->suggested_focal_distance_m, z_m);
  }
}

TEST(DepthBudget, countsSkyAsFarAway) {
  const AtlasLayout layout = layoutOf({.kind = evenQuilt(2.5, 0.7)});
  const DepthSpread sky{{.inv_z_low = 0, .inv_z_high = 1e-12, .count = 5}};
  const auto budget = depthBudget(layout, {}, sky);
  ASSERT_TRUE(budget);
  const double moved_px = disparities(layout, 3, 4, {1e12}).front();
  EXPECT_NEAR(budget->disparity_max_px, moved_px, 1e-6);
  EXPECT_EQ(budget->beyond_ghosting_share, moved_px > 8 ? 1 : 0);
  EXPECT_EQ(budget->suggested_focal_distance_m, kFocalDistanceMax_m);
}

TEST(DepthBudget, isOfTheWiderStepOfAGrid) {
  CamerasSpec cameras{.tile_size_px = {640, 360}};
  cameras.grid = CameraGrid{.columns = 2, .rows = 2, .spacing_m = {0.01, 0.05}};
  const AtlasLayout layout = layoutOf({.kind = cameras});
  const std::vector<double> z_m = depthPlane();
  const auto budget = depthBudget(layout, statsOf(z_m), spreadOf(z_m, 1e7));
  ASSERT_TRUE(budget);
  EXPECT_DOUBLE_EQ(budget->beyond_fusing_share, shareAbove(disparities(layout, 0, 2, z_m), 5));
  EXPECT_EQ(budget->suggested_view_cone_rad, 0) << "it has no cone";
}

TEST(DepthBudget, isNoneWhereNoViewsAreNeighbours) {
  const std::vector<double> z_m = depthPlane();
  const auto isNone = [&](const DisplaySpec& spec, const DepthSpread& spread) {
    return !depthBudget(layoutOf(spec), statsOf(z_m), spread).has_value();
  };
  const DepthSpread spread = spreadOf(z_m, 32);
  const CamerasSpec list{
      .cameras = {{.projection = Intrinsics{{80, 80}, {50, 50}}}, {.projection = Intrinsics{}}},
      .tile_size_px = {100, 100}};
  EXPECT_TRUE(isNone({.kind = list}, spread));
  EXPECT_TRUE(isNone({.kind = QuiltSpec{.columns = 1, .rows = 1, .size_px = {64, 64}}}, spread));
  EXPECT_TRUE(isNone({.kind = evenQuilt(2.5, 0.4)}, {})) << "no surface";
  EXPECT_FALSE(isNone({.kind = evenQuilt(2.5, 0.4)}, spread));
}

}  // namespace
}  // namespace viewloom::depth_budget_test
