// SPDX-License-Identifier: Apache-2.0
// Views of eyes before a tracked display, checked by projecting points through them.
#include "display/tracked_eyes.h"

#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::tracked_eyes_test {
namespace {

using testing::HasSubstr;

// Rounding of a handful of binary64 operations on numbers up to 1e4 px.
constexpr double kRounding_px = 1e-9;

// Textbook pinhole that looks along -z: where a point falls in a view's tile, px.
glm::dvec2 project(const Camera& camera, const glm::dvec3& point_m) {
  const glm::dvec3 p = point_m - camera.pose.position_m;
  const Intrinsics& k = camera.intrinsics;
  return {k.principal_px.x + k.focal_px.x * p.x / -p.z,
          k.principal_px.y - k.focal_px.y * p.y / -p.z};
}

// A rectangle 1.2 m high and 1.6 m wide, 2 m in front of the display's origin.
StereoSpec trackedStereo() {
  return {.eye_size_px = {640, 480},
          .focal_distance_m = 2,
          .fov_y_rad = 2 * std::atan(0.3),
          .is_tracked = true};
}

EyePoses eyesAt(const glm::dvec3& left_m, const glm::dvec3& right_m) {
  EyePoses poses{.time_ns = 1, .predicted_display_time_ns = 2};
  poses.eyes[0].pose.position_m = left_m;
  poses.eyes[1].pose.position_m = right_m;
  return poses;
}

absl::StatusOr<AtlasLayout> layoutOf(const StereoSpec& stereo, const EyePoses* eyes) {
  const absl::StatusOr<DisplaySpec> spec = completeDisplaySpec({.kind = stereo});
  EXPECT_TRUE(spec.ok()) << spec.status();
  const StreamDefaults stream{.source_intrinsics = {{500, 500}, {320, 240}},
                              .source_size_px = {640, 480},
                              .focal_distance_m = 3};
  return makeAtlasLayout(*spec, stream, eyes);
}

TEST(TrackedEyes, frameOneRectangleWhereverTheyStand) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> aside_m(-3, 3);
  std::uniform_real_distribution<double> forth_m(-1.9, 5);
  const auto place = [&] { return glm::dvec3(aside_m(random), aside_m(random), forth_m(random)); };
  for (int i = 0; i < 100; ++i) {
    const EyePoses poses = eyesAt(place(), place());
    const auto layout = layoutOf(trackedStereo(), &poses);
    ASSERT_TRUE(layout.ok()) << layout.status();
    for (size_t eye = 0; eye < 2; ++eye) {
      const Camera& camera = layout->views[eye].camera;
      EXPECT_EQ(camera.pose.position_m, poses.eyes[eye].pose.position_m);
      const glm::dvec2 top_left_px = project(camera, {-0.8, 0.6, -2});
      const glm::dvec2 bottom_right_px = project(camera, {0.8, -0.6, -2});
      EXPECT_NEAR(top_left_px.x, 0, kRounding_px);
      EXPECT_NEAR(top_left_px.y, 0, kRounding_px);
      EXPECT_NEAR(bottom_right_px.x, 640, kRounding_px);
      EXPECT_NEAR(bottom_right_px.y, 480, kRounding_px);
    }
  }
}

TEST(TrackedEyes, seeWhatTheFixedOnesDoInTheirPlace) {
  StereoSpec stereo = trackedStereo();
  stereo.focal_distance_m = 0;  // the stream's
  stereo.fov_y_rad = 0;         // and the source's
  const EyePoses poses = eyesAt({-0.0315, 0, 0}, {0.0315, 0, 0});
  const auto tracked = layoutOf(stereo, &poses);
  const auto fixed = layoutOf(stereo, nullptr);
  ASSERT_TRUE(tracked.ok() && fixed.ok());
  for (size_t eye = 0; eye < 2; ++eye) {
    EXPECT_EQ(tracked->views[eye].camera, fixed->views[eye].camera);
  }
  EXPECT_EQ(tracked->view_pitch_m, fixed->view_pitch_m);
}

TEST(TrackedEyes, areFramedHoweverTheyAreTurned) {
  EyePoses poses = eyesAt({-0.03, 0.1, 0.2}, {0.03, 0.1, 0.2});
  const auto straight = layoutOf(trackedStereo(), &poses);
  for (TrackedEye& eye : poses.eyes) {
    eye.pose.orientation = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)));
  }
  const auto turned = layoutOf(trackedStereo(), &poses);
  ASSERT_TRUE(straight.ok() && turned.ok());
  EXPECT_EQ(turned->views[1].camera, straight->views[1].camera);
}

TEST(TrackedEyes, withAProjectionSeeThat) {
  EyePoses poses = eyesAt({-0.03, 0, 0}, {0.03, 0, -7});  // the second far behind the focal plane
  poses.eyes[0].projection = Fov{-0.5, 0.4, 0.3, -0.2};
  poses.eyes[1].pose.orientation = glm::angleAxis(0.2, glm::dvec3(0, 1, 0));
  poses.eyes[1].projection = Intrinsics{{600, 610}, {300, 200}};
  const auto layout = layoutOf(trackedStereo(), &poses);
  ASSERT_TRUE(layout.ok()) << layout.status();
  const Camera& left = layout->views[0].camera;
  EXPECT_NEAR(project(left, left.pose.position_m + glm::dvec3(std::tan(0.4), 0, -1)).x, 640,
              kRounding_px);
  EXPECT_NEAR(project(left, left.pose.position_m + glm::dvec3(0, -std::tan(0.2), -1)).y, 480,
              kRounding_px);
  EXPECT_EQ(layout->views[1].camera,
            (Camera{poses.eyes[1].pose, Intrinsics{{600, 610}, {300, 200}}}));
}

TEST(TrackedEyes, keepTheFocalPlaneSharpUnderAFilter) {
  DisplaySpec spec{.kind = trackedStereo()};
  spec.filter.sample_count = 8;
  const EyePoses poses = eyesAt({-0.03, 0, 0.9}, {0.03, 0, 1.1});
  const auto layout = makeAtlasLayout(*completeDisplaySpec(spec), {}, &poses);
  ASSERT_TRUE(layout.ok()) << layout.status();
  ASSERT_EQ(layout->samples.size(), 8u);
  const glm::dvec3 on_plane_m(0.3, -0.2, -2);
  for (const View& view : layout->views) {
    const glm::dvec2 middle_px = project(view.camera, on_plane_m);
    for (const RaySample& sample : layout->samples) {
      const RaySample beside{.eye_m = sample.eye_m};
      const Camera seen = sampledCamera(view.camera, beside, layout->focusOf(view));
      EXPECT_NEAR(glm::distance(project(seen, on_plane_m), middle_px), 0, kRounding_px);
    }
  }
}

struct BadEyes {
  const char* name;
  glm::dvec3 right_m;
  const char* field;
};

TEST(TrackedEyes, areRefusedWhereTheySeeNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const BadEyes cases[] = {
      {"on the plane", {0, 0, -2}, "eye_poses.eyes[1].pose.position.z"},
      {"behind it", {0, 0, -2.5}, "eye_poses.eyes[1].pose.position.z"},
      {"nowhere", {0, 0, kNan}, "eye_poses.eyes[1].pose.position.z"},
      {"too close", {0, 0, -2 + 1e-12}, "eye_poses.eyes[1].pose.position"},
  };
  for (const BadEyes& bad : cases) {
    SCOPED_TRACE(bad.name);
    const EyePoses poses = eyesAt({0, 0, 0}, bad.right_m);
    const auto layout = layoutOf(trackedStereo(), &poses);
    EXPECT_EQ(layout.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(fieldOf(layout.status()), bad.field);
  }
  const EyePoses poses = eyesAt({0, 0, 0}, {0, 0, -3});
  EXPECT_THAT(std::string(validateInFront(poses, 2).message()),
              HasSubstr("z = -3 m, on or behind the focal plane; accepted is more than -2 m"));
  EXPECT_TRUE(validateInFront(poses, 3.5).ok());
}

TEST(TrackedEyes, areOneWhereTheDisplayShowsOneView) {
  StereoSpec stereo = trackedStereo();
  stereo.layout = StereoLayout::kSingle;
  EXPECT_EQ(trackedEyeCount({.kind = stereo}), 1u);
  const absl::StatusOr<AtlasLayout> untracked = layoutOf(stereo, nullptr);
  ASSERT_TRUE(untracked.ok()) << untracked.status();
  EXPECT_EQ(untracked->size_px, (SizePx{640, 480}));
  ASSERT_EQ(untracked->views.size(), 1u);
  EXPECT_EQ(untracked->views[0].camera.pose.position_m, glm::dvec3(0));
  EyePoses poses{.eyes = std::vector<TrackedEye>(1)};
  poses.eyes[0].pose.position_m = {0.25, 0.125, 0.5};
  const absl::StatusOr<AtlasLayout> tracked = layoutOf(stereo, &poses);
  ASSERT_TRUE(tracked.ok()) << tracked.status();
  ASSERT_EQ(tracked->views.size(), 1u);
  EXPECT_EQ(tracked->views[0].camera.pose.position_m, glm::dvec3(0.25, 0.125, 0.5));
  EXPECT_EQ(tracked->view_pitch_m, glm::dvec2(0));
}

TEST(TrackedEyes, areThoseOfAStereoDisplayWithoutOthers) {
  StereoSpec stereo = trackedStereo();
  EXPECT_TRUE(isTracked({.kind = stereo}));
  stereo.eyes.resize(2, {.projection = Intrinsics{{80, 80}, {50, 50}}});
  EXPECT_EQ(fieldOf(completeDisplaySpec({.kind = stereo}).status()), "stereo.eyes");
  stereo.is_tracked = false;
  EXPECT_FALSE(isTracked({.kind = stereo}));
  EXPECT_FALSE(isTracked({.kind = QuiltSpec{}}));
}

}  // namespace
}  // namespace viewloom::tracked_eyes_test
