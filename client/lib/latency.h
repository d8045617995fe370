// SPDX-License-Identifier: Apache-2.0
// Age of pictures when they are shown: since the capture of their frame, and since the motion of
// the eyes that see them.
#pragma once

#include <cstdint>
#include <optional>

#include "lib/atlas.h"
#include "lib/server_clock.h"

namespace viewloom {

// Latency of frames from capture to arrival. A picture that does not change has no latency.
// Thread-safety: none; one owner.
class FrameLatency {
 public:
  // Notes an atlas of this frame. Times in ns since 1970; the publisher gives the capture time.
  void note(uint64_t frame_number, int64_t capture_time_ns, int64_t now_ns);

  // Time from the capture of the newest frame to its arrival. Empty until a second frame has come,
  // because the first may be old. Also empty if the publisher uses another clock.
  std::optional<double> seconds() const { return latency_s_; }

  // Time without a new frame, s; empty during the first 2 s.
  std::optional<double> standing_s(int64_t now_ns) const;

 private:
  struct Frame {
    uint64_t number = 0;
    int64_t capture_time_ns = 0;
  };
  std::optional<Frame> newest_;
  int64_t came_ns_ = 0;  // first atlas of the newest frame
  std::optional<double> latency_s_;
};

// Latency from the motion of eyes to the picture that they see, in seconds. The parts add up to the
// total. to_server_s and back_s are as exact as the clock offset.
struct MotionLatency {
  double total_s = 0;      // by the clock of this process only
  double to_server_s = 0;  // from measurement to arrival at the server
  double waited_s = 0;     // at the server, until the first rays were submitted
  double made_s = 0;       // rendered and encoded
  double back_s = 0;       // until the picture arrived and was shown
};

// Latency of an atlas. The eyes were measured at `measured_ns` and the picture shown at `shown_ns`,
// both times of steadyNowNs(). Empty for an atlas without poses.
std::optional<MotionLatency> motionLatency(const Atlas& atlas, int64_t measured_ns,
                                           int64_t shown_ns, const ClockOffset& server);

}  // namespace viewloom
