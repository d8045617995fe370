// SPDX-License-Identifier: Apache-2.0
// How wide a lens is made that is to hide what would show beside itself.
#include <algorithm>

#include <gtest/gtest.h>

#include "display/atlas_layout.h"
#include "display/depth_budget.h"
#include "unit/display/axis_point.h"

namespace viewloom::lens_aperture_test {
namespace {

constexpr double kFocus_m = 2;
// Px of some 20 that a surface moves and is blurred by: rounding of binary64.
constexpr double kRounding_px = 1e-9;

// The 2nd and the 98th percentile of depth.
struct Range {
  double near_m;
  double far_m;
};

DisplaySpec withAutomaticLens(decltype(DisplaySpec::kind) kind) {
  DisplaySpec spec{.kind = std::move(kind)};
  spec.lens = LensSpec{.has_automatic_aperture = true};
  return spec;
}

absl::StatusOr<AtlasLayout> layoutOf(const DisplaySpec& spec, const Range& range) {
  const absl::StatusOr<DisplaySpec> completed = completeDisplaySpec(spec);
  EXPECT_TRUE(completed.ok()) << completed.status();
  return makeAtlasLayout(*completed,
                         {.source_intrinsics = {.focal_px = {900, 900}, .principal_px = {640, 360}},
                          .source_size_px = {1280, 720},
                          .focal_distance_m = kFocus_m,
                          .inv_z_near = 1 / range.near_m,
                          .inv_z_far = 1 / range.far_m});
}

// Eyes of the Bridge convention stand evenly.
QuiltSpec evenQuilt(double view_cone_rad) {
  return {.columns = 8,
          .rows = 1,
          .size_px = {8 * 640, 360},
          .view_cone_rad = view_cone_rad,
          .focal_distance_m = kFocus_m,
          .convention = CameraConvention::kBridge};
}

// From one side of the lens to the other a surface moves by as much as it is blurred, less what the
// plane in focus moves, which is not.
double blur_px(const AtlasLayout& layout, double z_m) {
  Camera left = layout.views.front().camera;
  Camera right = left;
  left.pose.position_m.x -= layout.lens->radius_m;
  right.pose.position_m.x += layout.lens->radius_m;
  const glm::dvec2 surface = axisPointIn(left, z_m) - axisPointIn(right, z_m);
  const glm::dvec2 focus =
      axisPointIn(left, layout.lens->focus_m) - axisPointIn(right, layout.lens->focus_m);
  return glm::length(surface - focus);
}

struct Case {
  const char* name;
  DisplaySpec spec;
  Range range;
  size_t neighbour;  // of view 0, where views step furthest
  double furthest_m;
};

CamerasSpec highGrid() {
  CamerasSpec cameras{.tile_size_px = {640, 360}};
  cameras.grid =
      CameraGrid{.columns = 2, .rows = 2, .spacing_m = {0.03, 0.15}, .focal_distance_m = kFocus_m};
  return cameras;
}

TEST(AutomaticAperture, leavesTheGhostingLimitOfWhatStepsFurthest) {
  const Case cases[] = {
      {"near", withAutomaticLens(evenQuilt(0.7)), {.near_m = 1, .far_m = 3}, 1, 1},
      {"far", withAutomaticLens(evenQuilt(0.7)), {.near_m = 1.6, .far_m = 50}, 1, 50},
      {"a grid's wider step", withAutomaticLens(highGrid()), {.near_m = 1, .far_m = 3}, 2, 1}};
  for (const Case& tried : cases) {
    SCOPED_TRACE(tried.name);
    const auto layout = layoutOf(tried.spec, tried.range);
    ASSERT_TRUE(layout.ok()) << layout.status();
    ASSERT_TRUE(layout->lens) << "nothing to blur";
    EXPECT_EQ(layout->lens->focus_m, kFocus_m);
    EXPECT_EQ(layout->lens_points.size(), layout->lens->pointCount() * size_t{64});
    const auto left_px = [&](double z_m) {
      const double step_px =
          axisPointStep_px(layout->views[0].camera, layout->views[tried.neighbour].camera, z_m);
      std::cout << tried.name << ": " << z_m << " m steps " << step_px << " px, blurred by "
                << blur_px(*layout, z_m) << "\n";
      return step_px - blur_px(*layout, z_m);
    };
    EXPECT_NEAR(left_px(tried.furthest_m), kGhostingLimit_px, kRounding_px);
    const double other_m =
        tried.furthest_m == tried.range.near_m ? tried.range.far_m : tried.range.near_m;
    EXPECT_LT(left_px(other_m), kGhostingLimit_px);
  }
}

// The lens may focus before or behind the focal plane. Surfaces keep their places.
TEST(AutomaticAperture, leavesTheGhostingLimitOfWhatIsBesideAnotherFocus) {
  const auto leftOf = [](double focus_m, const Range& range) {
    DisplaySpec spec = withAutomaticLens(evenQuilt(0.7));
    spec.lens->focus_distance_m = focus_m;
    const auto layout = layoutOf(spec, range);
    EXPECT_TRUE(layout.ok() && layout->lens) << layout.status();
    const auto left_px = [&](double z_m) {
      return axisPointStep_px(layout->views[0].camera, layout->views[1].camera, z_m) -
             blur_px(*layout, z_m);
    };
    return std::max(left_px(range.near_m), left_px(range.far_m));
  };
  EXPECT_NEAR(leftOf(1.8, {.near_m = 1, .far_m = 3}), kGhostingLimit_px, kRounding_px);
  EXPECT_NEAR(leftOf(4, {.near_m = 1, .far_m = 2.2}), kGhostingLimit_px, kRounding_px);
}

// No lens hides ghosting of surfaces in focus. The aperture must stay finite in that case.
TEST(AutomaticAperture, isNoWiderThanTheWayBetweenTwoEyes) {
  DisplaySpec spec = withAutomaticLens(evenQuilt(0.7));
  spec.lens->focus_distance_m = 1;
  const auto layout = layoutOf(spec, {.near_m = 1, .far_m = kFocus_m});
  ASSERT_TRUE(layout.ok() && layout->lens) << layout.status();
  EXPECT_DOUBLE_EQ(2 * layout->lens->radius_m, layout->view_pitch_m.x);
}

TEST(AutomaticAperture, isNoneWhereNoStepIsLonger) {
  const DisplaySpec spec = withAutomaticLens(evenQuilt(0.7));
  const auto stepOf = [](const AtlasLayout& layout, double z_m) {
    return axisPointStep_px(layout.views[0].camera, layout.views[1].camera, z_m);
  };
  const auto wide = layoutOf(spec, {.near_m = 1, .far_m = kFocus_m});
  ASSERT_TRUE(wide.ok()) << wide.status();
  // Steps grow with 1/Z beside that of the focus.
  const double limit_inv_z = kGhostingLimit_px / stepOf(*wide, 1) * (1 - 1 / kFocus_m);
  const auto nearOf = [&](double of_limit) { return 1 / (1 / kFocus_m + of_limit * limit_inv_z); };
  const Range below{.near_m = nearOf(0.99), .far_m = kFocus_m};
  const auto sharp = layoutOf(spec, below);
  ASSERT_TRUE(sharp.ok()) << sharp.status();
  EXPECT_LT(stepOf(*sharp, below.near_m), kGhostingLimit_px);
  EXPECT_FALSE(sharp->lens);
  EXPECT_TRUE(sharp->lens_points.empty());
  EXPECT_EQ(sharp->samples.size(), 1u) << "rays for nothing";
  const Range above{.near_m = nearOf(1.01), .far_m = kFocus_m};
  const auto blurred = layoutOf(spec, above);
  ASSERT_TRUE(blurred.ok()) << blurred.status();
  EXPECT_GT(stepOf(*blurred, above.near_m), kGhostingLimit_px);
  EXPECT_TRUE(blurred->lens);
}

TEST(AutomaticAperture, failsWhereThereIsNoDepthBudget) {
  const Range range{.near_m = 1, .far_m = 50};
  const CamerasSpec list{
      .cameras = {{.projection = Intrinsics{{80, 80}, {50, 50}}}, {.projection = Intrinsics{}}},
      .tile_size_px = {100, 100}};
  DisplaySpec alone = withAutomaticLens(QuiltSpec{.columns = 1, .rows = 1, .size_px = {64, 64}});
  DisplaySpec unrelated = withAutomaticLens(list);
  unrelated.lens->focus_distance_m = kFocus_m;
  for (const DisplaySpec& spec : {alone, unrelated}) {
    const absl::Status status = layoutOf(spec, range).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition) << status;
    EXPECT_NE(status.message().find("effects.lens.automatic_aperture"), std::string::npos)
        << status;
  }
  unrelated.lens->focus_distance_m.reset();
  const absl::Status status = layoutOf(unrelated, range).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition) << status;
  EXPECT_NE(status.message().find("effects.lens.focus_distance_m"), std::string::npos) << status;
}

}  // namespace
}  // namespace viewloom::lens_aperture_test
