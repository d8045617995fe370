// SPDX-License-Identifier: Apache-2.0
// Where the eyes before one tracked display are: a slot, in which the newest poses replace those
// before, and how fast they come.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "display/tracked_eyes.h"

namespace viewloom {

// When the newest poses came, by the server's monotonic clock, and how long after those before.
struct PoseTimes {
  int64_t received_ns = 0;
  int64_t interval_ns = 0;  // 0 = none came before
};

// Thread-safety: all methods may be called from any thread; none blocks on anything but the lock.
class EyeTrack {
 public:
  void put(EyePoses poses) {
    EyePosesPtr newest = std::make_shared<const EyePoses>(std::move(poses));
    std::lock_guard lock(mutex_);
    if (newest_) interval_ns_ = newest->received_ns - newest_->received_ns;
    newest_.swap(newest);
  }

  // They stay in the slot: frames to come are seen by the same eyes. nullptr = none came yet.
  EyePosesPtr newest() const {
    std::lock_guard lock(mutex_);
    return newest_;
  }

  // Of the same.
  PoseTimes times() const {
    std::lock_guard lock(mutex_);
    if (!newest_) return {};
    return {.received_ns = newest_->received_ns, .interval_ns = interval_ns_};
  }

 private:
  mutable std::mutex mutex_;
  EyePosesPtr newest_;
  int64_t interval_ns_ = 0;  // between it and the one before
};

using EyeTrackPtr = std::shared_ptr<EyeTrack>;

}  // namespace viewloom
