// SPDX-License-Identifier: Apache-2.0
// Where the eyes before one tracked display are: a slot, in which the newest poses replace those
// before.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "display/tracked_eyes.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread; none blocks on anything but the lock.
class EyeTrack {
 public:
  void put(EyePoses poses) {
    EyePosesPtr newest = std::make_shared<const EyePoses>(std::move(poses));
    std::lock_guard lock(mutex_);
    newest_.swap(newest);
  }

  // They stay in the slot: frames to come are seen by the same eyes. nullptr = none came yet.
  EyePosesPtr newest() const {
    std::lock_guard lock(mutex_);
    return newest_;
  }

 private:
  mutable std::mutex mutex_;
  EyePosesPtr newest_;
};

using EyeTrackPtr = std::shared_ptr<EyeTrack>;

}  // namespace viewloom
