// SPDX-License-Identifier: Apache-2.0
#include "temporal/camera_track.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace viewloom {
namespace {

bool isTimed(const TrackedFrame& frame) {
  return std::max(frame.captured_ns, -(frame.captured_ns + 1)) < kTrackedTimeMax_ns;
}

// The axis in the world, as long as the angle: 0..pi.
glm::dvec3 turnBetween(const glm::dquat& from, const glm::dquat& to) {
  glm::dquat turn = to * glm::conjugate(from);
  if (turn.w < 0) turn = -turn;
  const glm::dvec3 axis(turn.x, turn.y, turn.z);
  const double sine = glm::length(axis);
  if (sine == 0) return glm::dvec3(0);
  return 2 * std::atan2(sine, turn.w) / sine * axis;
}

// nullopt: a cut.
std::optional<PoseMotion> motionBetween(const Pose& before, const Pose& pose, int64_t interval_ns,
                                        double inv_z_near) {
  const glm::dvec3 way_m = pose.position_m - before.position_m;
  const glm::dvec3 turn_rad = turnBetween(before.orientation, pose.orientation);
  if (glm::length(way_m) * inv_z_near > 1 || glm::length(turn_rad) > kCutTurn_rad) {
    return std::nullopt;
  }
  const double interval_s = 1e-9 * double(interval_ns);
  return PoseMotion{.pose = pose,
                    .before = before,
                    .velocity_mps = way_m / interval_s,
                    .turn_rad_per_s = turn_rad / interval_s};
}

// Where sources that are not the first say themselves how their surfaces move, their cameras don't.
std::vector<TrackedSource> otherSources(const Frame& frame, const Frame* before) {
  std::vector<TrackedSource> others;
  for (size_t i = 1; i < frame.sources.size(); ++i) {
    TrackedSource& other = others.emplace_back();
    other.pose = frame.format.sources[i].camera.pose;
    if (movesByItself(frame, i)) {
      other.content = ContentMotion::kStands;
    } else if (before != nullptr && i < before->sources.size()) {
      other.content = contentMotion(*before, frame, i);
    }
  }
  return others;
}

}  // namespace

TrackedFrame trackedFrame(const Frame& frame, const Frame* before, double inv_z_near) {
  const int64_t captured_ns = frame.format.capture_time_ns;
  return {.pose = frame.format.sources.front().camera.pose,
          .captured_ns = captured_ns,
          .arrived_ns = captured_ns,
          .built_ns = captured_ns,
          .inv_z_near = inv_z_near,
          .things_move = movesByItself(frame),
          .others = otherSources(frame, before)};
}

const CameraMotion& CameraTrack::add(const TrackedFrame& frame) {
  are_things_.resize(frame.others.size());
  if (last_ && isTimed(frame) && isTimed(*last_) && frame.captured_ns > last_->captured_ns) {
    measure(frame);
  } else {
    begin(frame);
  }
  motion_.things_move = frame.things_move && isTimed(frame);
  last_ = frame;
  return motion_;
}

void CameraTrack::begin(const TrackedFrame& frame) {
  motion_ = {.camera = {.pose = frame.pose, .before = frame.pose},
             .captured_ns = frame.captured_ns};
  if (isTimed(frame)) motion_.least_delay_ns = frame.arrived_ns - frame.captured_ns;
}

void CameraTrack::measure(const TrackedFrame& frame) {
  const int64_t interval_ns = frame.captured_ns - last_->captured_ns;
  const int64_t delay_ns = frame.arrived_ns - frame.captured_ns;
  const int64_t passed_ns = std::max(frame.arrived_ns - last_->arrived_ns, int64_t{0});
  const int64_t least_delay_ns =
      std::min(delay_ns, motion_.least_delay_ns + int64_t(kClockDriftMax * double(passed_ns)));
  const int64_t asked_lag_ns =
      interval_ns + std::max(frame.built_ns - least_delay_ns - frame.captured_ns, int64_t{0});
  const int64_t lag_ns = motion_.lag_ns == 0
                             ? asked_lag_ns
                             : motion_.lag_ns + (asked_lag_ns - motion_.lag_ns) / kLagStepsPerFrame;
  motion_ = {.camera = {.pose = frame.pose, .before = last_->pose},
             .captured_ns = frame.captured_ns,
             .least_delay_ns = least_delay_ns,
             .lag_ns = lag_ns};
  if (interval_ns > kTrackedIntervalMax_ns) return;
  const double inv_z_near = std::max(frame.inv_z_near, last_->inv_z_near);
  const auto camera = motionBetween(last_->pose, frame.pose, interval_ns, inv_z_near);
  if (!camera) return;
  motion_.interval_ns = interval_ns;
  motion_.camera = *camera;
  noteThings(frame, interval_ns, inv_z_near);
}

// Notes the things that moved since the frame before. A thing that was just put there has not
// moved.
void CameraTrack::noteThings(const TrackedFrame& frame, int64_t interval_ns, double inv_z_near) {
  const size_t count = std::min(frame.others.size(), last_->others.size());
  for (size_t i = 0; i < count; ++i) {
    const TrackedSource& source = frame.others[i];
    const Pose& before = last_->others[i].pose;
    if (source.content != ContentMotion::kUnclear) {
      are_things_[i] = source.content == ContentMotion::kWithCamera;
    }
    if (!are_things_[i] || source.pose == before) continue;
    const PoseMotion stands{.pose = source.pose, .before = source.pose};
    motion_.things.push_back(
        {.source = i + 1,
         .motion = motionBetween(before, source.pose, interval_ns, inv_z_near).value_or(stands)});
  }
}

}  // namespace viewloom
