// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "display/display_spec.h"

namespace viewloom::camera_lists_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

CamerasSpec goodCameras() {
  return {.cameras = {{.projection = Intrinsics{{100, 100}, {50, 50}}}},
          .tile_size_px = {100, 100}};
}

TEST(CameraLists, nameTheCameraAtFault) {
  CamerasSpec cameras = goodCameras();
  cameras.cameras.resize(3, cameras.cameras[0]);
  cameras.cameras[2].pose.position_m.x = kNan;
  EXPECT_THAT(fieldOf(completeDisplaySpec({.kind = cameras}).status()),
              StartsWith("cameras.cameras[2].pose"));
  cameras.cameras[1].projection = Fov{.left_rad = 0.5, .right_rad = -0.5};
  EXPECT_THAT(fieldOf(completeDisplaySpec({.kind = cameras}).status()),
              StartsWith("cameras.cameras[1].fov"));
  cameras.cameras[0].projection = Intrinsics{{0, 100}, {0, 0}};
  EXPECT_THAT(fieldOf(completeDisplaySpec({.kind = cameras}).status()),
              StartsWith("cameras.cameras[0].intrinsics"));
}

TEST(CameraLists, ofAWrongLengthAreRefusedBeforeTheirCameras) {
  ViewCamera bad = goodCameras().cameras[0];
  bad.pose.position_m.x = kNan;
  const StereoSpec stereo{.eye_size_px = {640, 480}, .eyes = {bad, bad, bad}};
  const absl::Status three = completeDisplaySpec({.kind = stereo}).status();
  EXPECT_EQ(fieldOf(three), "stereo.eyes");
  EXPECT_THAT(std::string(three.message()), HasSubstr("got 3 entries; accepted is 1..2"));
  CamerasSpec cameras = goodCameras();
  cameras.cameras.assign(1025, bad);
  const absl::Status many = completeDisplaySpec({.kind = cameras}).status();
  EXPECT_EQ(fieldOf(many), "cameras.cameras");
  EXPECT_THAT(std::string(many.message()), HasSubstr("got 1025 entries; accepted is 1..1024"));
}

}  // namespace
}  // namespace viewloom::camera_lists_test
