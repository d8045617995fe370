// SPDX-License-Identifier: Apache-2.0
// How a camera is followed from frame to frame, and carried on between them.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>

#include "temporal/camera_track.h"

namespace viewloom::camera_motion_test {
namespace {

constexpr int64_t kMs_ns = 1'000'000;
constexpr int64_t kBridge_ns = 250 * kMs_ns;
constexpr int64_t kDelay_ns = 40 * kMs_ns;
constexpr int64_t kBuild_ns = 15 * kMs_ns;  // until it can be traced

// Moves and turns evenly; captured in the publisher's clock, whose epoch is another.
Pose poseAt(double time_s) {
  return {.position_m = glm::dvec3(0.5, -0.25, 0.125) * time_s,
          .orientation = glm::angleAxis(0.4 * time_s, glm::normalize(glm::dvec3(1, 2, 0.5)))};
}

TrackedFrame frameAt(int64_t captured_ns, int64_t delay_ns = kDelay_ns) {
  return {.pose = poseAt(1e-9 * double(captured_ns)),
          .captured_ns = captured_ns,
          .arrived_ns = captured_ns + delay_ns,
          .built_ns = captured_ns + delay_ns + kBuild_ns,
          .inv_z_near = 0.5};
}

void expectNear(const Pose& got, const Pose& wanted) {
  EXPECT_LT(glm::length(got.position_m - wanted.position_m), 1e-9);
  EXPECT_GT(std::abs(glm::dot(got.orientation, wanted.orientation)), 1 - 1e-12);
}

TEST(CameraMotion, carriesAnEvenMotionOnForAsLongAsFramesAreApart) {
  CameraTrack track;
  track.add(frameAt(1000 * kMs_ns));
  const CameraMotion motion = track.add(frameAt(1100 * kMs_ns));
  for (const int64_t age_ms : {1, 20, 60, 100}) {
    const int64_t time_ns = (1100 + age_ms) * kMs_ns;
    const ShownInstant shown = predicted(motion, time_ns + kDelay_ns, kBridge_ns);
    EXPECT_EQ(shown.timing, Timing::kPredicted);
    EXPECT_EQ(shown.time_ns, time_ns);
    expectNear(shown.source_pose, poseAt(1e-9 * double(time_ns)));
  }
}

TEST(CameraMotion, slowsDownEvenlyThenHoldsAndSaysSo) {
  CameraTrack track;
  track.add(frameAt(1000 * kMs_ns));
  const CameraMotion motion = track.add(frameAt(1100 * kMs_ns));
  const auto wayAt = [&](int64_t age_ms) {
    const ShownInstant shown = predicted(motion, (1100 + age_ms) * kMs_ns + kDelay_ns, kBridge_ns);
    EXPECT_EQ(shown.timing, age_ms < 250 ? Timing::kPredicted : Timing::kHeld) << age_ms;
    return glm::length(shown.source_pose.position_m - motion.camera.pose.position_m) /
           glm::length(motion.camera.velocity_mps);
  };
  // Full speed to 0.1 s; half of it, on the mean, to 0.25 s.
  EXPECT_NEAR(wayAt(100), 0.1, 1e-9);
  EXPECT_NEAR(wayAt(175), 0.1 + 0.075 * 0.75, 1e-9);
  EXPECT_NEAR(wayAt(249), 0.1 + 0.15 / 2, 1e-5);
  EXPECT_NEAR(wayAt(250), 0.1 + 0.15 / 2, 1e-9);
  EXPECT_EQ(wayAt(100'000), wayAt(250));
  const ShownInstant held = predicted(motion, 9000 * kMs_ns, kBridge_ns);
  EXPECT_EQ(held.time_ns, (1100 + 250) * kMs_ns);
  EXPECT_TRUE(held.looksLike(predicted(motion, 9999 * kMs_ns, kBridge_ns)));
}

TEST(CameraMotion, aBridgeShorterThanTheIntervalEndsAtFullSpeed) {
  CameraTrack track;
  track.add(frameAt(0));
  const CameraMotion motion = track.add(frameAt(500 * kMs_ns));
  const ShownInstant held = predicted(motion, 5000 * kMs_ns, kBridge_ns);
  EXPECT_EQ(held.timing, Timing::kHeld);
  expectNear(held.source_pose, poseAt(0.75));
}

TEST(CameraMotion, standsStillAfterOneFrameOrBetweenTwoFromOnePlace) {
  CameraTrack track;
  const CameraMotion first = track.add(frameAt(0));
  const ShownInstant shown = predicted(first, 900 * kMs_ns, kBridge_ns);
  EXPECT_EQ(shown.timing, Timing::kCaptured);
  EXPECT_EQ(shown.time_ns, 0);
  TrackedFrame same = frameAt(0);
  same.captured_ns += 100 * kMs_ns;
  same.arrived_ns += 100 * kMs_ns;
  const CameraMotion second = track.add(same);
  EXPECT_FALSE(second.isMoving());
  EXPECT_TRUE(predicted(second, 900 * kMs_ns, kBridge_ns).source_pose == same.pose);
}

TEST(CameraMotion, liesBetweenTwoFramesOneIntervalLater) {
  CameraTrack track;
  track.add(frameAt(1000 * kMs_ns));
  const CameraMotion motion = track.add(frameAt(1100 * kMs_ns));
  // From the build of the second frame to that of the third, shown time runs from the first frame
  // to the second.
  const int64_t built_ns = 1100 * kMs_ns + kDelay_ns + kBuild_ns;
  const ShownInstant start = interpolated(motion, built_ns, kBridge_ns);
  EXPECT_EQ(start.timing, Timing::kCaptured);
  EXPECT_EQ(start.time_ns, 1000 * kMs_ns);
  expectNear(start.source_pose, poseAt(1.0));
  for (const int64_t age_ms : {1, 30, 99}) {
    const int64_t time_ns = (1000 + age_ms) * kMs_ns;
    const ShownInstant shown = interpolated(motion, built_ns + age_ms * kMs_ns, kBridge_ns);
    EXPECT_EQ(shown.timing, Timing::kInterpolated);
    EXPECT_EQ(shown.time_ns, time_ns);
    expectNear(shown.source_pose, poseAt(1e-9 * double(time_ns)));
  }
  const ShownInstant end = interpolated(motion, built_ns + 100 * kMs_ns, kBridge_ns);
  EXPECT_EQ(end.timing, Timing::kCaptured);
  expectNear(end.source_pose, poseAt(1.1));
  EXPECT_EQ(interpolated(motion, built_ns + 120 * kMs_ns, kBridge_ns).timing, Timing::kPredicted);
  EXPECT_EQ(interpolated(motion, built_ns + 900 * kMs_ns, kBridge_ns).timing, Timing::kHeld);
}

TEST(CameraMotion, carriesThingsOnWhereTheCameraStands) {
  CameraTrack track;
  TrackedFrame frame{.pose = {},
                     .captured_ns = 1000 * kMs_ns,
                     .arrived_ns = 1000 * kMs_ns + kDelay_ns,
                     .inv_z_near = 0.5,
                     .things_move = true};
  const CameraMotion first = track.add(frame);
  ASSERT_TRUE(first.isMoving());
  EXPECT_EQ(predicted(first, frame.arrived_ns, kBridge_ns).carried_ns, 0);
  // How far frames are apart is not known yet: speed falls at once, half of the way is left.
  EXPECT_EQ(predicted(first, frame.arrived_ns + kBridge_ns, kBridge_ns).carried_ns, kBridge_ns / 2);
  frame.captured_ns += 100 * kMs_ns;
  frame.arrived_ns += 100 * kMs_ns;
  frame.built_ns = frame.arrived_ns;
  const CameraMotion motion = track.add(frame);
  const ShownInstant shown = predicted(motion, frame.arrived_ns + 40 * kMs_ns, kBridge_ns);
  EXPECT_EQ(shown.timing, Timing::kPredicted);
  EXPECT_EQ(shown.carried_ns, 40 * kMs_ns);
  EXPECT_EQ(shown.source_pose, Pose{});
  EXPECT_FALSE(shown.looksLike(predicted(motion, frame.arrived_ns, kBridge_ns)));
  EXPECT_EQ(predicted(motion, frame.arrived_ns + 2 * kBridge_ns, kBridge_ns).timing, Timing::kHeld);
  const ShownInstant between = interpolated(motion, frame.arrived_ns + 70 * kMs_ns, kBridge_ns);
  EXPECT_EQ(between.timing, Timing::kInterpolated);
  EXPECT_EQ(between.carried_ns, -30 * kMs_ns);
}

TEST(CameraMotion, doesNotStandBetweenFramesOnBothSidesOfACut) {
  CameraTrack track;
  TrackedFrame frame = frameAt(0);
  frame.things_move = true;
  track.add(frame);
  TrackedFrame far = frameAt(100 * kMs_ns);
  far.things_move = true;
  far.pose.position_m.x += 3;
  const CameraMotion motion = track.add(far);
  EXPECT_TRUE(motion.isMoving());
  EXPECT_EQ(motion.interval_ns, 0);
  EXPECT_EQ(interpolated(motion, far.arrived_ns, kBridge_ns).source_pose, far.pose);
}

TEST(CameraMotion, aLostFrameTurnsNoTimeBack) {
  CameraTrack track;
  CameraMotion motion;
  int64_t shown_ns = 0;
  for (int64_t i = 0; i < 60; ++i) {
    if (i % 7 == 3) continue;
    const TrackedFrame frame = frameAt(i * 50 * kMs_ns);
    motion = track.add(frame);
    if (!motion.isMoving()) continue;
    const int64_t now_ns = interpolated(motion, frame.built_ns, kBridge_ns).time_ns;
    EXPECT_GE(now_ns, shown_ns) << i;
    shown_ns = interpolated(motion, frame.built_ns + 40 * kMs_ns, kBridge_ns).time_ns;
  }
}

TEST(CameraTrack, readsThePublishersClockByTheLeastDelay) {
  CameraTrack track;
  int64_t least_ns = 0;
  for (int i = 0; i < 50; ++i) {
    const int64_t late_ns = i == 20 ? 0 : (1 + i * 7 % 13) * kMs_ns;
    least_ns = track.add(frameAt(i * 33 * kMs_ns, kDelay_ns + late_ns)).least_delay_ns;
    if (i >= 20) {
      // It may grow by 0.2 ms a second: the clocks may run apart.
      EXPECT_GE(least_ns, kDelay_ns);
      EXPECT_LE(least_ns, kDelay_ns + kMs_ns / 4) << i;
    }
  }
}

TEST(CameraTrack, followsAClockThatRunsSlow) {
  CameraTrack track;
  CameraMotion motion;
  for (int64_t i = 0; i < 2000; ++i) {  // by 100 ppm
    TrackedFrame frame = frameAt(i * 100 * kMs_ns);
    frame.arrived_ns += i * 100 * kMs_ns / 10'000;
    motion = track.add(frame);
    EXPECT_EQ(motion.least_delay_ns, frame.arrived_ns - frame.captured_ns);
  }
}

TEST(CameraTrack, beginsAnewWhenCaptureTimesStandOrGoBack) {
  for (const int64_t second_ms : {1000, 500, -700}) {
    CameraTrack track;
    track.add(frameAt(1000 * kMs_ns));
    const TrackedFrame back = frameAt(second_ms * kMs_ns, 90 * kMs_ns);
    const CameraMotion motion = track.add(back);
    EXPECT_FALSE(motion.isMoving());
    EXPECT_EQ(motion.least_delay_ns, 90 * kMs_ns);
    EXPECT_TRUE(track.add(frameAt((second_ms + 50) * kMs_ns)).isMoving());
  }
}

TEST(CameraTrack, takesTimesOfAnySize) {
  constexpr int64_t kLowest = std::numeric_limits<int64_t>::min();
  constexpr int64_t kHighest = std::numeric_limits<int64_t>::max();
  CameraTrack track;
  double place_m = 0;
  for (const int64_t time_ns : {kLowest, kHighest, kLowest + 1, int64_t{0}, kHighest, kHighest,
                                -kTrackedTimeMax_ns, kTrackedTimeMax_ns - 1}) {
    const CameraMotion motion = track.add({.pose = {.position_m = {place_m += 0.1, 0, 0}},
                                           .captured_ns = time_ns,
                                           .arrived_ns = kMs_ns,
                                           .inv_z_near = 0.5,
                                           .things_move = std::abs(double(time_ns)) > 3e18});
    EXPECT_FALSE(motion.isMoving()) << time_ns;
    const ShownInstant shown = predicted(motion, 2 * kMs_ns, kBridge_ns);
    EXPECT_EQ(shown.time_ns, time_ns);
  }
}

TEST(CameraTrack, takesALeapForACut) {
  CameraTrack track;
  track.add(frameAt(0));
  TrackedFrame far = frameAt(33 * kMs_ns);
  far.pose.position_m.x += 2.1;  // the nearest surfaces are 2 m away
  EXPECT_FALSE(track.add(far).isMoving());
  TrackedFrame turned = far;
  turned.captured_ns += 33 * kMs_ns;
  turned.pose.orientation = glm::angleAxis(0.9, glm::dvec3(0, 1, 0)) * far.pose.orientation;
  EXPECT_FALSE(track.add(turned).isMoving());
  TrackedFrame later = turned;
  later.captured_ns += kTrackedIntervalMax_ns + 1;
  later.pose.position_m.x += 0.1;
  EXPECT_FALSE(track.add(later).isMoving()) << "too long ago";
}

}  // namespace
}  // namespace viewloom::camera_motion_test
