// SPDX-License-Identifier: Apache-2.0
#include "eye_poses/eye_track.h"

#include <utility>

namespace viewloom {

EyeTrack::EyeTrack(const EyeTrack& before) {
  std::lock_guard lock(before.mutex_);
  newest_ = before.newest_;
  interval_ns_ = before.interval_ns_;
}

void EyeTrack::put(EyePoses poses) {
  EyePosesPtr newest = std::make_shared<const EyePoses>(std::move(poses));
  std::lock_guard lock(mutex_);
  if (newest_) interval_ns_ = newest->received_ns - newest_->received_ns;
  newest_.swap(newest);
}

EyePosesPtr EyeTrack::newest() const {
  std::lock_guard lock(mutex_);
  return newest_;
}

PoseTimes EyeTrack::times() const {
  std::lock_guard lock(mutex_);
  if (!newest_) return {};
  return {.received_ns = newest_->received_ns, .interval_ns = interval_ns_};
}

void EyeTrack::noteUsed(EyePosesPtr poses) {
  std::lock_guard lock(mutex_);
  used_.swap(poses);
}

EyePosesPtr EyeTrack::used() const {
  std::lock_guard lock(mutex_);
  return used_;
}

EyeTrackPtr trackOf(const DisplaySpec& display, const EyeTrackPtr& before) {
  if (!isTracked(display)) return nullptr;
  const EyePosesPtr newest = before == nullptr ? nullptr : before->newest();
  const bool are_its_eyes = newest != nullptr && newest->eyes.size() == trackedEyeCount(display);
  return are_its_eyes ? std::make_shared<EyeTrack>(*before) : std::make_shared<EyeTrack>();
}

}  // namespace viewloom
