// SPDX-License-Identifier: Apache-2.0
// Which displays are swept, and along which rows.
#include "sweep/sweep_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>

namespace viewloom::sweep_plan_test {
namespace {

constexpr SizePx kSource_px{960, 540};
constexpr Intrinsics kSourceIntrinsics{{831, 831}, {480, 270}};
constexpr double kInvZMax = 0.5;  // 1/m
constexpr SizePx kTile_px{96, 54};

Camera sourceAt(const Pose& pose) {
  return {.pose = pose, .intrinsics = kSourceIntrinsics};
}

// A pose that its own inverse does not cancel exactly.
Pose slantedPose() {
  return {.position_m = {12.3, -4.56, 78.9},
          .orientation = glm::normalize(glm::dquat(0.3, -0.5, 0.7, 0.41))};
}

TraceJob jobOf(DisplaySpec spec, const Camera& source) {
  spec = completeDisplaySpec(spec).value();
  const StreamDefaults defaults{
      .source_intrinsics = source.intrinsics, .source_size_px = kSource_px, .focal_distance_m = 3};
  return makeTraceJob(std::make_shared<const AtlasLayout>(makeAtlasLayout(spec, defaults).value()),
                      spec, displayPose(spec, source), source, kSource_px);
}

std::optional<SweepPlan> planOf(const DisplaySpec& spec, const Camera& source = sourceAt({})) {
  return SweepPlan::make(jobOf(spec, source), kInvZMax);
}

DisplaySpec quilt() {
  DisplaySpec spec;
  spec.kind = QuiltSpec{.preset = "", .columns = 4, .rows = 3, .size_px = {384, 162}};
  return spec;
}

DisplaySpec stereo() {
  DisplaySpec spec;
  spec.kind = StereoSpec{.layout = StereoLayout::kSideBySide, .eye_size_px = kTile_px};
  return spec;
}

ViewCamera cameraAt(const Pose& pose, const glm::dvec2& principal_px = {48, 27}) {
  return {.pose = pose, .projection = Intrinsics{{83, 83}, principal_px}};
}

DisplaySpec cameras(const std::vector<ViewCamera>& list) {
  DisplaySpec spec;
  spec.kind = CamerasSpec{.cameras = list, .tile_size_px = kTile_px, .columns = 2};
  return spec;
}

bool isSwept(const Pose& pose) {
  return planOf(cameras({cameraAt(pose)})).has_value();
}

Pose turned(double angle_rad, const glm::dvec3& axis) {
  return {.position_m = {}, .orientation = glm::angleAxis(angle_rad, axis)};
}

TEST(SweepPlan, takesAQuiltInTheSourcesPlace) {
  const std::optional<SweepPlan> plan = planOf(quilt());
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->rowCount(), 54u);
  EXPECT_EQ(plan->groupOf(0).tiles.size(), 12u);
}

TEST(SweepPlan, takesBothEyesOfAStereoPair) {
  const std::optional<SweepPlan> plan = planOf(stereo());
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->groupOf(0).tiles, (std::vector<uint32_t>{0, 1}));
  EXPECT_LT(plan->viewOf(0).eye_px_m, 0);
  EXPECT_FLOAT_EQ(plan->viewOf(0).eye_px_m, -plan->viewOf(1).eye_px_m);
}

TEST(SweepPlan, takesEyesBesideTheSource) {
  EXPECT_TRUE(isSwept({.position_m = {0.2, 0, 0}}));
  EXPECT_FALSE(isSwept({.position_m = {0.2, 0.01, 0}})) << "above";
  EXPECT_FALSE(isSwept({.position_m = {0.2, 0, -0.01}})) << "before";
  EXPECT_FALSE(isSwept({.position_m = {0.2, 0, 0.01}})) << "behind";
}

TEST(SweepPlan, leavesTurnedViews) {
  const double mrad = 1e-3;
  EXPECT_FALSE(isSwept(turned(mrad, {1, 0, 0})));
  EXPECT_FALSE(isSwept(turned(mrad, {0, 1, 0})));
  EXPECT_FALSE(isSwept(turned(mrad, {0, 0, 1})));
  EXPECT_FALSE(isSwept(turned(std::numbers::pi, {0, 1, 0}))) << "looks away";
}

TEST(SweepPlan, leavesRowsThatRunToTheLeft) {
  EXPECT_FALSE(isSwept(turned(std::numbers::pi, {0, 0, 1})));
  TraceJob job = jobOf(cameras({cameraAt({})}), sourceAt({}));
  ASSERT_TRUE(SweepPlan::make(job, kInvZMax).has_value());
  job.tiles[0].direction_dx.x *= -1;
  EXPECT_FALSE(SweepPlan::make(job, kInvZMax).has_value());
}

TEST(SweepPlan, oneViewThatIsNotSweptLeavesTheDisplay) {
  const Pose above{.position_m = {0, 0.1, 0}};
  EXPECT_TRUE(planOf(cameras({cameraAt({}), cameraAt({})})).has_value());
  EXPECT_FALSE(planOf(cameras({cameraAt({}), cameraAt(above)})).has_value());
}

TEST(SweepPlan, aSourceOfSkyAloneSeesNoEyeMove) {
  const TraceJob job = jobOf(cameras({cameraAt({.position_m = {0, 1, 1}})}), sourceAt({}));
  EXPECT_TRUE(SweepPlan::make(job, 0).has_value());
}

TEST(SweepPlan, tilesOfTheSameRowsAreOneGroup) {
  const ViewCamera left = cameraAt({.position_m = {-0.1, 0, 0}}, {40, 27});
  const ViewCamera right = cameraAt({.position_m = {0.1, 0, 0}}, {56, 27});
  const ViewCamera lower = cameraAt({}, {48, 20});
  const TraceJob job = jobOf(cameras({left, lower, right}), sourceAt({}));
  const std::optional<SweepPlan> plan = SweepPlan::make(job, kInvZMax);
  ASSERT_TRUE(plan.has_value());
  ASSERT_EQ(plan->rowCount(), 2 * kTile_px.height);
  const SweptTiles& first = plan->groupOf(0);
  const SweptTiles& second = plan->groupOf(kTile_px.height);
  EXPECT_EQ(first.tiles, (std::vector<uint32_t>{0, 2}));
  EXPECT_EQ(second.tiles, (std::vector<uint32_t>{1}));
  EXPECT_EQ(&plan->groupOf(kTile_px.height - 1), &first);
  EXPECT_EQ(plan->tileRow(kTile_px.height + 3), 3u);
  EXPECT_EQ(first.tolerance, std::min(job.tiles[0].inv_z_tolerance, job.tiles[2].inv_z_tolerance));
  EXPECT_NEAR(second.first_px - first.first_px, 7 * 831.0 / 83, 1e-3);  // roundings of 1e2 px
}

// Row r of a view through the middle of px r: of the source at once, from its own place.
TEST(SweepPlan, rowsAndPixelsOfTheSourcesOwnViewAreItsOwn) {
  DisplaySpec spec;
  spec.kind = CamerasSpec{.cameras = {{.pose = {}, .projection = kSourceIntrinsics}},
                          .tile_size_px = kSource_px,
                          .columns = 1};
  const SweepPlan plan = planOf(spec).value();
  EXPECT_EQ(plan.groupOf(0).first_px, 0.5);
  EXPECT_NEAR(plan.groupOf(0).step_px, 1, 1e-6);  // an ulp of binary32
  EXPECT_NEAR(plan.viewOf(0).start_px, 0.5, 1e-6);
  EXPECT_NEAR(plan.viewOf(0).step_px, 1, 1e-6);
  EXPECT_EQ(plan.viewOf(0).eye_px_m, 0);
}

TEST(SweepPlan, posesThatCancelButForRoundingsAreSwept) {
  for (const DisplaySpec& spec : {quilt(), stereo()}) {
    const SweepPlan plain = planOf(spec).value();
    const std::optional<SweepPlan> plan = planOf(spec, sourceAt(slantedPose()));
    ASSERT_TRUE(plan.has_value());
    EXPECT_EQ(plan->rowCount(), plain.rowCount()) << "tiles lost their common rows";
    EXPECT_NEAR(plan->groupOf(0).first_px, plain.groupOf(0).first_px, 1e-3);
  }
}

TEST(SweepPlan, aDisplayInTheSourcesPlaceByItsOwnPoseIsSwept) {
  const Pose pose = slantedPose();
  DisplaySpec spec = quilt();
  spec.world_pose = pose;
  EXPECT_TRUE(planOf(spec, sourceAt(pose)).has_value());
  spec.world_pose->position_m.y += 0.01;
  EXPECT_FALSE(planOf(spec, sourceAt(pose)).has_value());
}

TEST(SweepPlan, tilesWithoutAViewHaveNoPart) {
  const SweepPlan plan = planOf(cameras({cameraAt({}), cameraAt({}), cameraAt({})})).value();
  EXPECT_EQ(plan.groupOf(0).tiles, (std::vector<uint32_t>{0, 1, 2}));
}

}  // namespace
}  // namespace viewloom::sweep_plan_test
