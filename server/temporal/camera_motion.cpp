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

Pose moved(const CameraMotion& motion, double seconds) {
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

}  // namespace

ShownInstant predicted(const CameraMotion& motion, int64_t server_ns, int64_t bridge_ns) {
  const ShownInstant captured{motion.captured_ns, Timing::kCaptured, motion.pose};
  if (!motion.isMoving()) return captured;
  const int64_t age_ns = server_ns - motion.least_delay_ns - motion.captured_ns;
  if (age_ns <= 0) return captured;
  const double carried_s = carriedSeconds(age_ns, motion.interval_ns, bridge_ns);
  const Pose pose = moved(motion, carried_s);
  const int64_t carried_ns = motion.things_move ? std::llround(1e9 * carried_s) : 0;
  if (age_ns >= bridge_ns) return {motion.captured_ns + bridge_ns, Timing::kHeld, pose, carried_ns};
  return {motion.captured_ns + age_ns, Timing::kPredicted, pose, carried_ns};
}

ShownInstant interpolated(const CameraMotion& motion, int64_t server_ns, int64_t bridge_ns) {
  const int64_t lagging_ns = server_ns - motion.lag_ns;
  if (!motion.isMoving() || motion.interval_ns == 0) {
    return predicted(motion, lagging_ns, bridge_ns);
  }
  const int64_t age_ns = lagging_ns - motion.least_delay_ns - motion.captured_ns;
  if (age_ns >= 0) return predicted(motion, lagging_ns, bridge_ns);
  if (age_ns <= -motion.interval_ns) {
    return {motion.captured_ns - motion.interval_ns, Timing::kCaptured, motion.before,
            motion.things_move ? -motion.interval_ns : 0};
  }
  const double share = 1 + double(age_ns) / double(motion.interval_ns);
  const Pose between{
      .position_m = glm::mix(motion.before.position_m, motion.pose.position_m, share),
      .orientation = glm::slerp(motion.before.orientation, motion.pose.orientation, share)};
  return {motion.captured_ns + age_ns, Timing::kInterpolated, between,
          motion.things_move ? age_ns : 0};
}

}  // namespace viewloom
