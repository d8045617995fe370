// SPDX-License-Identifier: Apache-2.0
// How old pictures are when they are shown: since the capture of their frame, and since the motion
// of the eyes that see them.
#pragma once

#include <cstdint>
#include <optional>

#include "lib/atlas.h"
#include "lib/server_clock.h"

namespace viewloom {

// Latency of the frames that come while somebody watches. The age of a picture that stands is none.
// Thread-safety: none; one owner.
class FrameLatency {
 public:
  // An atlas of this frame is here. Times in ns since 1970; capture times are the publisher's word.
  void note(uint64_t frame_number, int64_t capture_time_ns, int64_t now_ns);

  // From the capture of the newest frame to here. None before a second frame has come, as the first
  // may have stood long before; none either where the publisher's clock is another.
  std::optional<double> seconds() const { return latency_s_; }

  // How long no new frame has come; none within the first two seconds.
  std::optional<double> standing_s(int64_t now_ns) const;

 private:
  struct Frame {
    uint64_t number = 0;
    int64_t capture_time_ns = 0;
  };
  std::optional<Frame> newest_;
  int64_t came_ns_ = 0;  // the newest frame, for the first time
  std::optional<double> latency_s_;
};

// From the motion of eyes to the picture that they see: how long, and where the time went.
// Seconds; the parts add up to the total. Those of the way are as exact as the clocks are known.
struct MotionLatency {
  double total_s = 0;      // by this process's clock alone
  double to_server_s = 0;  // measured, until the server had them
  double waited_s = 0;     // there, until the first rays were submitted
  double made_s = 0;       // traced and encoded
  double back_s = 0;       // until the picture was here, and shown
};

// How long an atlas took. The eyes were measured at the one time, and it was shown at the other,
// both by steadyNowNs(). None for an atlas without poses.
std::optional<MotionLatency> motionLatency(const Atlas& atlas, int64_t measured_ns,
                                           int64_t shown_ns, const ClockOffset& server);

}  // namespace viewloom
