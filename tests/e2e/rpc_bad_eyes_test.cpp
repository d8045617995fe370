// SPDX-License-Identifier: Apache-2.0
// Eye poses that nothing can be seen by, or that nobody asked for.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "e2e/bystander.h"
#include "e2e/refusal.h"

namespace viewloom::rpc_bad_eyes_test {
namespace {

constexpr auto kInvalid = grpc::StatusCode::INVALID_ARGUMENT;
constexpr auto kNotNow = grpc::StatusCode::FAILED_PRECONDITION;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Two eyes of 8x8 px, tracked; the focal plane is 2 m away, or with 0 where the stream has it: 1 m.
v1::OpenDisplay trackedEyes(double focal_distance_m) {
  v1::OpenDisplay open = smallQuilt("healthy");
  v1::StereoDisplay& stereo = *open.mutable_display()->mutable_stereo();
  stereo.mutable_eye_size()->set_width(8);
  stereo.mutable_eye_size()->set_height(8);
  stereo.set_focal_distance_m(focal_distance_m);
  stereo.set_tracked(true);
  return open;
}

v1::StreamAtlasesRequest goodEyes() {
  v1::StreamAtlasesRequest request;
  for (const double x_m : {-0.03, 0.03}) {
    request.mutable_eye_poses()->add_eyes()->mutable_pose()->mutable_position()->set_x(x_m);
  }
  return request;
}

v1::Vector3& placeOf(v1::EyePoses& poses, int eye) {
  return *poses.mutable_eyes(eye)->mutable_pose()->mutable_position();
}

struct BadEyes {
  const char* name;
  std::function<void(v1::EyePoses&)> spoil;  // good ones
  Refusal refusal;
};

TEST(EyePoses, areRefusedWhereNothingIsSeenByThem) {
  const std::vector<BadEyes> cases = {
      {"none", [](auto& p) { p.clear_eyes(); }, {kInvalid, "eye_poses.eyes"}},
      {"three", [](auto& p) { p.add_eyes(); }, {kInvalid, "eye_poses.eyes"}},
      {"nowhere",
       [](auto& p) { placeOf(p, 1).set_y(kNan); },
       {kInvalid, "eye_poses.eyes[1].pose.position"}},
      {"on another star",
       [](auto& p) { placeOf(p, 0).set_z(1e16); },
       {kInvalid, "eye_poses.eyes[0].pose.position"}},
      {"on the focal plane",
       [](auto& p) { placeOf(p, 1).set_z(-2); },
       {kInvalid, "eye_poses.eyes[1].pose.position.z"}},
      {"behind it",
       [](auto& p) { placeOf(p, 0).set_z(-2.1); },
       {kInvalid, "eye_poses.eyes[0].pose.position.z"}},
      {"turned and stretched",
       [](auto& p) { p.mutable_eyes(0)->mutable_pose()->mutable_orientation()->set_w(2); },
       {kInvalid, "eye_poses.eyes[0].pose.orientation"}},
      {"seeing from right to left",
       [](auto& p) { p.mutable_eyes(1)->mutable_fov()->set_angle_left_rad(0.1); },
       {kInvalid, "eye_poses.eyes[1].fov.angle_right_rad"}},
      {"without focal length",
       [](auto& p) { p.mutable_eyes(1)->mutable_intrinsics()->set_focal_y_px(5); },
       {kInvalid, "eye_poses.eyes[1].intrinsics.focal_x_px"}},
  };
  TestServer server;
  Bystander bystander(server);
  for (const BadEyes& bad : cases) {
    SCOPED_TRACE(bad.name);
    TestWatcher watcher(server.connect(), trackedEyes(2));
    watcher.send(goodEyes());
    v1::StreamAtlasesRequest request = goodEyes();
    bad.spoil(*request.mutable_eye_poses());
    watcher.send(request);
    EXPECT_EQ(refusalOf(watcher.finish()), bad.refusal);
    bystander.expectUndisturbed();
  }
}

TEST(EyePoses, areRefusedIfTheyAreTwoOfADisplayOfOneEye) {
  TestServer server;
  Bystander bystander(server);
  v1::OpenDisplay open = trackedEyes(2);
  open.mutable_display()->mutable_stereo()->set_layout(v1::STEREO_LAYOUT_SINGLE);
  TestWatcher watcher(server.connect(), open);
  v1::StreamAtlasesRequest one = goodEyes();
  one.mutable_eye_poses()->mutable_eyes()->RemoveLast();
  watcher.send(one);
  watcher.send(goodEyes());
  EXPECT_EQ(refusalOf(watcher.finish()), (Refusal{kInvalid, "eye_poses.eyes"}));
  bystander.expectUndisturbed();
}

TEST(EyePoses, areRefusedBehindTheFocalPlaneOfTheStream) {
  TestServer server;
  Bystander bystander(server);
  bystander.expectUndisturbed();
  TestWatcher watcher(server.connect(), trackedEyes(0));
  ASSERT_TRUE(watcher.readAtlas().has_value());
  v1::StreamAtlasesRequest request = goodEyes();
  placeOf(*request.mutable_eye_poses(), 0).set_z(-0.9);
  watcher.send(request);
  placeOf(*request.mutable_eye_poses(), 0).set_z(-1);
  watcher.send(request);
  EXPECT_EQ(refusalOf(watcher.finish()), (Refusal{kInvalid, "eye_poses.eyes[0].pose.position.z"}));
  bystander.expectUndisturbed();
}

TEST(EyePoses, areRefusedForDisplaysThatAreNotTracked) {
  TestServer server;
  Bystander bystander(server);
  TestWatcher quilt(server.connect(), smallQuilt("healthy"));
  quilt.send(goodEyes());
  EXPECT_EQ(refusalOf(quilt.finish()), (Refusal{kNotNow, "eye_poses"}));
  TestWatcher changed(server.connect(), trackedEyes(2));
  changed.send(goodEyes());
  v1::StreamAtlasesRequest change;
  *change.mutable_change()->mutable_display() = smallQuilt("healthy").display();
  changed.send(change);
  changed.send(goodEyes());
  EXPECT_EQ(refusalOf(changed.finish()), (Refusal{kNotNow, "eye_poses"}));
  TestWatcher early(server.connect());
  early.send(goodEyes());
  EXPECT_EQ(refusalOf(early.finish()), (Refusal{kInvalid, "message"}));
  bystander.expectUndisturbed();
}

TEST(EyePoses, makeADisplayItsClientsAlone) {
  TestServer server;
  Bystander bystander(server);
  bystander.expectUndisturbed();
  TestWatcher one(server.connect(), trackedEyes(2));
  TestWatcher other(server.connect(), trackedEyes(2));
  ASSERT_TRUE(one.readAtlas().has_value());
  ASSERT_TRUE(other.readAtlas().has_value());
  const auto displays = server.broadcaster().displays("healthy");
  ASSERT_EQ(displays.size(), 3u);
  EXPECT_NE(displays[1]->picture_key, displays[2]->picture_key);
  EXPECT_NE(displays[1]->eyes, displays[2]->eyes);
}

}  // namespace
}  // namespace viewloom::rpc_bad_eyes_test
