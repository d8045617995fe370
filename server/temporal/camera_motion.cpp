// SPDX-License-Identifier: Apache-2.0
#include "temporal/camera_motion.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace viewloom {
namespace {

// For how long the camera would have gone at its full speed to where it is at this age.
double carriedSeconds(int64_t age_ns, int64_t interval_ns, int64_t bridge_ns) {
  const double age_s = 1e-9 * double(std::min(age_ns, bridge_ns));
  const double steady_s = 1e-9 * double(std::min(interval_ns, bridge_ns));
  if (age_s <= steady_s) return age_s;
  const double slowing_s = 1e-9 * double(bridge_ns) - steady_s;
  const double slowed_s = age_s - steady_s;
  return steady_s + slowed_s - slowed_s * slowed_s / (2 * slowing_s);
}

Pose moved(const PoseMotion& motion, double seconds) {
  Pose pose = motion.pose;
  pose.position_m += seconds * motion.velocity_mps;
  const double speed_rad_per_s = glm::length(motion.turn_rad_per_s);
  if (speed_rad_per_s > 0) {
    const glm::dquat turn =
        glm::angleAxis(seconds * speed_rad_per_s, motion.turn_rad_per_s / speed_rad_per_s);
    pose.orientation = glm::normalize(turn * pose.orientation);
  }
  return pose;
}

// share: of the way from the frame before to the newest.
Pose between(const PoseMotion& motion, double share) {
  return {.position_m = glm::mix(motion.before.position_m, motion.pose.position_m, share),
          .orientation = glm::slerp(motion.before.orientation, motion.pose.orientation, share)};
}

template <typename PoseOf>
std::vector<ThingPose> posesOf(const std::vector<ThingMotion>& things, PoseOf poseOf) {
  std::vector<ThingPose> poses;
  for (const ThingMotion& thing : things) poses.push_back({thing.source, poseOf(thing.motion)});
  return poses;
}

}  // namespace

ShownInstant predicted(const CameraMotion& motion, int64_t server_ns, int64_t bridge_ns) {
  const ShownInstant captured{
      .time_ns = motion.captured_ns,
      .timing = Timing::kCaptured,
      .source_pose = motion.camera.pose,
      .things = posesOf(motion.things, [](const PoseMotion& thing) { return thing.pose; })};
  if (!motion.isMoving()) return captured;
  const int64_t age_ns = server_ns - motion.least_delay_ns - motion.captured_ns;
  if (age_ns <= 0) return captured;
  const double carried_s = carriedSeconds(age_ns, motion.interval_ns, bridge_ns);
  const bool is_held = age_ns >= bridge_ns;
  return {.time_ns = motion.captured_ns + std::min(age_ns, bridge_ns),
          .timing = is_held ? Timing::kHeld : Timing::kPredicted,
          .source_pose = moved(motion.camera, carried_s),
          .carried_ns = motion.things_move ? std::llround(1e9 * carried_s) : 0,
          .things = posesOf(motion.things,
                            [&](const PoseMotion& thing) { return moved(thing, carried_s); })};
}

ShownInstant interpolated(const CameraMotion& motion, int64_t server_ns, int64_t bridge_ns) {
  const int64_t lagging_ns = server_ns - motion.lag_ns;
  if (!motion.isMoving() || motion.interval_ns == 0) {
    return predicted(motion, lagging_ns, bridge_ns);
  }
  const int64_t age_ns = lagging_ns - motion.least_delay_ns - motion.captured_ns;
  if (age_ns >= 0) return predicted(motion, lagging_ns, bridge_ns);
  if (age_ns <= -motion.interval_ns) {
    return {.time_ns = motion.captured_ns - motion.interval_ns,
            .timing = Timing::kCaptured,
            .source_pose = motion.camera.before,
            .carried_ns = motion.things_move ? -motion.interval_ns : 0,
            .things = posesOf(motion.things, [](const PoseMotion& thing) { return thing.before; })};
  }
  const double share = 1 + double(age_ns) / double(motion.interval_ns);
  return {.time_ns = motion.captured_ns + age_ns,
          .timing = Timing::kInterpolated,
          .source_pose = between(motion.camera, share),
          .carried_ns = motion.things_move ? age_ns : 0,
          .things = posesOf(motion.things,
                            [&](const PoseMotion& thing) { return between(thing, share); })};
}

}  // namespace viewloom
