// SPDX-License-Identifier: Apache-2.0
// Tracked stereo displays of a whole server, beside fixed ones, as clients decode them.
#include <thread>

#include "e2e/service_eyes_fixture.h"

namespace viewloom::test::service_eyes_test {
namespace {

// The eye stands in the source's row plane, in front of it, aside of the display, and above.
TEST_F(ServiceEyesTest, showsWhatFixedEyesInTheirPlaceWouldSee) {
  struct Case {
    Place left;
    Place right;
    v1::TraceMethod method;
  };
  const Case cases[] = {
      {{-0.125, 0, 0}, {0.0625, 0, 0}, v1::TRACE_METHOD_SWEEP},
      {{-0.1, 0.05, 0.25}, {-0.04, 0.0625, 0.3}, v1::TRACE_METHOD_WALK},
      {{0.5, -0.25, -0.5}, {0.5625, -0.25, -0.5}, v1::TRACE_METHOD_WALK},
      {{0.25, 0, 0}, {0.3125, 0, 0}, v1::TRACE_METHOD_SWEEP},
  };
  publish();
  const auto tracked = view(openTracked());
  int64_t time_ns = 1'000;
  for (const Case& eyes : cases) {
    SCOPED_TRACE(time_ns);
    const Atlas atlas = tracked->seenBy(posesAt(++time_ns, eyes.left, eyes.right));
    EXPECT_EQ(atlas.header.predicted_display_time_ns(), time_ns + 11'000'000);
    const Atlas fixed = fixedAt(eyes.left, eyes.right);
    EXPECT_EQ(colorOf(atlas), colorOf(fixed));
    EXPECT_EQ(atlas.header.method(), fixed.header.method());
    if (service_->engineRoom().description().is_software) {
      EXPECT_EQ(atlas.header.method(), eyes.method);
    }
    ASSERT_EQ(atlas.layout->views_size(), 2);
    EXPECT_EQ(atlas.layout->views(0).pose().position().x(), eyes.left.x_m);
    EXPECT_EQ(atlas.layout->views(1).pose().position().z(), eyes.right.z_m);
    EXPECT_NEAR(atlas.layout->views(1).intrinsics().principal_x_px(),
                fixed.layout->views(1).intrinsics().principal_x_px(), 1e-9);
  }
}

v1::OpenDisplay single(v1::OpenDisplay open) {
  open.mutable_display()->mutable_stereo()->set_layout(v1::STEREO_LAYOUT_SINGLE);
  return open;
}

TEST_F(ServiceEyesTest, showsOneEyeWhatAFixedOneInItsPlaceWouldSee) {
  publish();
  const auto tracked = view(single(openTracked()));
  const Atlas first = tracked->waitForFrame(1);
  ASSERT_EQ(first.layout->views_size(), 1);
  EXPECT_EQ(first.layout->size().width(), kEyeWidth_px);
  EXPECT_EQ(first.layout->views(0).pose().position().x(), 0) << "in the middle";
  int64_t time_ns = 0;
  for (const Place& at : {Place{0.25, 0, 0}, Place{-0.1, 0.05, 0.25}}) {
    v1::EyePoses poses = posesAt(++time_ns, at, at);
    poses.mutable_eyes()->RemoveLast();
    const Atlas atlas = tracked->seenBy(poses);
    v1::OpenDisplay open = single(openEyes());
    addWindowCamera(*open.mutable_display()->mutable_stereo(), at);
    const Atlas fixed = view(open)->waitForFrame(1);
    EXPECT_EQ(colorOf(atlas), colorOf(fixed));
    EXPECT_EQ(atlas.layout->views(0).pose().position().x(), at.x_m);
  }
}

TEST_F(ServiceEyesTest, standsInForEyesUntilTheyCome) {
  publish();
  const auto tracked = view(openTracked());
  const Atlas atlas = tracked->waitForFrame(1);
  EXPECT_EQ(atlas.header.eye_poses_time_ns(), 0);
  EXPECT_EQ(atlas.header.predicted_display_time_ns(), 0);
  EXPECT_EQ(colorOf(atlas), colorOf(fixedAt({-0.0315, 0, 0}, {0.0315, 0, 0})));
}

TEST_F(ServiceEyesTest, tracesAFrameThatStandsOncePerPoseAndNoMore) {
  publish();
  const auto tracked = view(openTracked());
  tracked->waitForFrame(1);
  for (int64_t time_ns = 1; time_ns <= 5; ++time_ns) {
    const double x_m = 0.01 * double(time_ns);
    const Atlas atlas = tracked->seenBy(posesAt(time_ns, {-x_m, 0, 0}, {x_m, 0, 0}));
    EXPECT_EQ(atlas.header.frame_number(), 1u);
    EXPECT_EQ(atlas.header.sequence(), uint64_t(time_ns) + 1);
  }
  // Whatever else there was to trace has begun before this display's.
  fixedAt({-0.1, 0.1, 0.1}, {0.1, 0.1, 0.1});
  EXPECT_EQ(tracedCount(), 1 + 5 + 1);
  // The eyes stay where they are for frames to come.
  publish();
  EXPECT_EQ(tracked->waitForFrame(2).header.eye_poses_time_ns(), 5);
}

TEST_F(ServiceEyesTest, showsEachClientItsOwnEyes) {
  publish();
  const auto one = view(openTracked());
  const auto other = view(openTracked());
  const auto fixed = view(openEyes());
  const std::vector<uint8_t> before = colorOf(fixed->waitForFrame(1));
  one->watcher().sendEyePoses(posesAt(7, {-0.25, 0, 0}, {-0.1875, 0, 0}));
  other->watcher().sendEyePoses(posesAt(8, {0.1875, 0.125, 0}, {0.25, 0.125, 0}));
  EXPECT_EQ(colorOf(one->waitForEyes(7)), colorOf(fixedAt({-0.25, 0, 0}, {-0.1875, 0, 0})));
  EXPECT_EQ(colorOf(other->waitForEyes(8)), colorOf(fixedAt({0.1875, 0.125, 0}, {0.25, 0.125, 0})));
  EXPECT_EQ(fixed->watcher().counts().atlases.whole, 1u) << "nothing has changed for it";
  EXPECT_EQ(colorOf(fixedAt({-0.0315, 0, 0}, {0.0315, 0, 0})), before);
}

TEST_F(ServiceEyesTest, keepsTheEyesOfAChangedDisplay) {
  publish();
  const auto tracked = view(openTracked());
  const Atlas small = tracked->seenBy(posesAt(3, {-0.25, 0, 0}, {-0.1875, 0, 0}));
  v1::ChangeDisplay change;
  *change.mutable_display() = openTracked().display();
  change.mutable_display()->mutable_stereo()->set_layout(v1::STEREO_LAYOUT_TOP_BOTTOM);
  tracked->watcher().change(change);
  const Atlas other =
      tracked->waitFor([](const Atlas& atlas) { return atlas.layout->rows() == 2; });
  EXPECT_EQ(other.header.eye_poses_time_ns(), 3);
  EXPECT_EQ(other.layout->views(0).pose().position().x(), -0.25);
}

TEST_F(ServiceEyesTest, leavesOthersTheirFramesHoweverFastPosesCome) {
  constexpr uint64_t kFrameCount = 10;
  const auto tracked = view(openTracked());
  const auto fixed = view(openEyes());
  publish();
  fixed->waitForFrame(1);
  std::jthread flood([&](const std::stop_token& stop) {
    for (int64_t time_ns = 1; !stop.stop_requested(); ++time_ns) {
      const double x_m = 0.2 * std::sin(0.01 * double(time_ns));
      tracked->watcher().sendEyePoses(posesAt(time_ns, {x_m, 0, 0}, {x_m + 0.0625, 0, 0}));
    }
  });
  for (uint64_t number = 2; number <= kFrameCount; ++number) {
    publish();
    EXPECT_EQ(fixed->waitForFrame(number).header.sequence(), number);
    tracked->waitForFrame(number);
  }
  flood.request_stop();
  flood.join();
  const Atlas last = tracked->seenBy(posesAt(-5, {0.25, 0, 0}, {0.3125, 0, 0}));
  EXPECT_EQ(last.header.frame_number(), kFrameCount);
  EXPECT_EQ(colorOf(last), colorOf(fixedAt({0.25, 0, 0}, {0.3125, 0, 0})));
}

TEST_F(ServiceEyesTest, endsWithEyesThatTheStreamPutsBehindItsFocalPlane) {
  v1::OpenDisplay open = openTracked();
  open.mutable_display()->mutable_stereo()->set_focal_distance_m(0);
  const auto tracked = view(open);
  tracked->watcher().sendEyePoses(posesAt(1, {0, 0, 0}, {0, 0, -1e6}));
  // Its end may come before the frame does, never without it.
  const std::jthread frames([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) publish();
  });
  ASSERT_TRUE(tracked->watcher().waitEnded(std::chrono::nanoseconds(kGiveUpAfter).count()));
  const absl::Status ended = *tracked->watcher().ended();
  EXPECT_EQ(ended.code(), absl::StatusCode::kInvalidArgument) << ended;
  EXPECT_TRUE(std::string(ended.message()).starts_with("eye_poses.eyes[1].pose.position.z: "))
      << ended;
}

}  // namespace
}  // namespace viewloom::test::service_eyes_test
