// SPDX-License-Identifier: Apache-2.0
// Latency of the frames that come while somebody watches. The age of a picture that stands is none.
#pragma once

#include <cstdint>
#include <optional>

namespace viewloom {

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

}  // namespace viewloom
