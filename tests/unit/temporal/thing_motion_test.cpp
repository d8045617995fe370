// SPDX-License-Identifier: Apache-2.0
// How sources are carried on that show things, and go with them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

#include "temporal/camera_track.h"

namespace viewloom::thing_motion_test {
namespace {

constexpr int64_t kMs_ns = 1'000'000;
constexpr int64_t kBridge_ns = 250 * kMs_ns;

// Moves and turns evenly.
Pose poseAt(double time_s) {
  return {.position_m = glm::dvec3(0.5, -0.25, 0.125) * time_s,
          .orientation = glm::angleAxis(0.4 * time_s, glm::normalize(glm::dvec3(1, 2, 0.5)))};
}

void expectNear(const Pose& got, const Pose& wanted) {
  EXPECT_LT(glm::length(got.position_m - wanted.position_m), 1e-9);
  EXPECT_GT(std::abs(glm::dot(got.orientation, wanted.orientation)), 1 - 1e-12);
}

// Seen by a camera that stands, 0.1 s later than the frame before; the second source shows a thing.
TrackedFrame thingFrame(int64_t index, ContentMotion content) {
  const int64_t captured_ns = index * 100 * kMs_ns;
  TrackedFrame frame{.pose = {},
                     .captured_ns = captured_ns,
                     .arrived_ns = captured_ns + 40 * kMs_ns,
                     .built_ns = captured_ns + 40 * kMs_ns,
                     .inv_z_near = 0.5};
  frame.others = {{.pose = {.position_m = {5, 0, 0}}, .content = ContentMotion::kUnclear},
                  {.pose = poseAt(0.1 * double(index)), .content = content}};
  return frame;
}

TEST(ThingMotion, carriesASourceOnThatGoesWithItsThing) {
  CameraTrack track;
  track.add(thingFrame(0, ContentMotion::kUnclear));
  const TrackedFrame frame = thingFrame(1, ContentMotion::kWithCamera);
  const CameraMotion motion = track.add(frame);
  EXPECT_TRUE(motion.isMoving());
  const auto thingAt = [](const ShownInstant& shown) {
    EXPECT_EQ(shown.source_pose, Pose{});
    EXPECT_EQ(shown.carried_ns, 0) << "nothing is built";
    EXPECT_EQ(shown.things.size(), 1U);
    EXPECT_EQ(shown.things.front().source, 2U);
    return shown.things.front().pose;
  };
  const ShownInstant shown = predicted(motion, frame.arrived_ns + 60 * kMs_ns, kBridge_ns);
  expectNear(thingAt(shown), poseAt(0.16));
  EXPECT_FALSE(shown.looksLike(predicted(motion, frame.arrived_ns, kBridge_ns)));
  // Half as far while it slows down as at full speed.
  const ShownInstant held = predicted(motion, frame.arrived_ns + 2 * kBridge_ns, kBridge_ns);
  EXPECT_EQ(held.timing, Timing::kHeld);
  expectNear(thingAt(held), poseAt(0.1 + 0.1 + 0.15 / 2));
  expectNear(thingAt(interpolated(motion, frame.arrived_ns + 30 * kMs_ns, kBridge_ns)),
             poseAt(0.03));
  expectNear(thingAt(interpolated(motion, frame.arrived_ns, kBridge_ns)), poseAt(0));
}

TEST(ThingMotion, knowsThingsAgainUntilTheyAreSeenToStand) {
  CameraTrack track;
  const auto thingsAfter = [&](int64_t index, ContentMotion content) {
    return track.add(thingFrame(index, content)).things.size();
  };
  EXPECT_EQ(thingsAfter(0, ContentMotion::kUnclear), 0U);
  EXPECT_EQ(thingsAfter(1, ContentMotion::kUnclear), 0U)
      << "a camera like the first, for all we know";
  EXPECT_EQ(thingsAfter(2, ContentMotion::kWithCamera), 1U);
  EXPECT_EQ(thingsAfter(3, ContentMotion::kUnclear), 1U);
  EXPECT_EQ(thingsAfter(3, ContentMotion::kUnclear), 0U) << "times that stand";
  EXPECT_EQ(thingsAfter(4, ContentMotion::kUnclear), 1U);
  EXPECT_EQ(thingsAfter(5, ContentMotion::kStands), 0U);
  EXPECT_EQ(thingsAfter(6, ContentMotion::kUnclear), 0U);
}

TEST(ThingMotion, leavesAThingWhereItWasPut) {
  CameraTrack track;
  track.add(thingFrame(0, ContentMotion::kUnclear));
  TrackedFrame frame = thingFrame(1, ContentMotion::kWithCamera);
  frame.others[1].pose.position_m.x += 3;
  const CameraMotion motion = track.add(frame);
  for (const int64_t age_ms : {-70, 0, 50}) {
    const int64_t now_ns = frame.arrived_ns + age_ms * kMs_ns;
    EXPECT_EQ(predicted(motion, now_ns, kBridge_ns).things.front().pose, frame.others[1].pose);
    EXPECT_EQ(interpolated(motion, now_ns, kBridge_ns).things.front().pose, frame.others[1].pose);
  }
}

}  // namespace
}  // namespace viewloom::thing_motion_test
