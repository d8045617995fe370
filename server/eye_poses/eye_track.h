// SPDX-License-Identifier: Apache-2.0
// Where the eyes before one tracked display are, how fast their poses come, and which of them its
// picture shows.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>

#include "display/tracked_eyes.h"

namespace viewloom {

// When the newest poses came, by the server's monotonic clock, and how long after those before.
struct PoseTimes {
  int64_t received_ns = 0;
  int64_t interval_ns = 0;  // 0 = none came before
};

// A slot, in which the newest poses replace those before: poses never queue.
// Thread-safety: all methods may be called from any thread; none blocks on anything but the lock.
class EyeTrack {
 public:
  EyeTrack() = default;
  // Another display of the same eyes, which shows none of their poses yet.
  explicit EyeTrack(const EyeTrack& before);
  EyeTrack& operator=(const EyeTrack&) = delete;

  void put(EyePoses poses);

  // They stay in the slot: frames to come are seen by the same eyes. nullptr = none came yet.
  EyePosesPtr newest() const;
  // When the newest came.
  PoseTimes times() const;

  // The display's newest picture is made for these poses, nullptr = for none, as newest() gave
  // them. This is the only place that knows.
  void noteUsed(EyePosesPtr poses);
  EyePosesPtr used() const;

 private:
  mutable std::mutex mutex_;
  EyePosesPtr newest_;
  int64_t interval_ns_ = 0;  // between it and the one before
  EyePosesPtr used_;
};

using EyeTrackPtr = std::shared_ptr<EyeTrack>;

// The track of a display that takes the place of another, seen by the same eyes if there are as
// many of them. `before`: the other's track, nullptr = there is none. nullptr if nobody tracks the
// eyes of the display.
EyeTrackPtr trackOf(const DisplaySpec& display, const EyeTrackPtr& before);

// Takes the poses of eyes in, as FrameSink takes frames.
class EyeSink {
 public:
  virtual ~EyeSink() = default;
  // Newer poses are in the track of a tracked display. Called for each of them, on the thread that
  // brings them; must not block.
  virtual void serveEyes(uint64_t display_id) = 0;
};

}  // namespace viewloom
