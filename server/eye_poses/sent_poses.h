// SPDX-License-Identifier: Apache-2.0
// The eye poses of the atlases that one client got last: what it shows tells how long that took.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace viewloom {

// Thread-safety: none.
class SentPoses {
 public:
  // An atlas goes out; the client's clock.
  void note(uint64_t sequence, int64_t poses_time_ns) {
    newest_ = (newest_ + 1) % sent_.size();
    sent_[newest_] = {.sequence = sequence, .poses_time_ns = poses_time_ns};
  }
  // The sequence of another display starts anew.
  void clear() { sent_ = {}; }

  // From the eyes' motion to its picture, both times of the client's clock. None for an atlas that
  // was not sent, or long ago; for one without poses; and where it is no latency: a negative one,
  // or one over a minute, is the difference of two clocks.
  std::optional<double> latencySeconds(uint64_t sequence, int64_t presented_time_ns) const {
    for (const Sent& sent : sent_) {
      if (sent.sequence != sequence || sent.poses_time_ns == 0) continue;
      // Floating point, because clients may send any time.
      const double latency_s = (double(presented_time_ns) - double(sent.poses_time_ns)) * 1e-9;
      if (latency_s >= 0 && latency_s < kLatencyMax_s) return latency_s;
    }
    return std::nullopt;
  }

 private:
  static constexpr double kLatencyMax_s = 60;

  struct Sent {
    uint64_t sequence = 0;  // 0 = none
    int64_t poses_time_ns = 0;
  };

  std::array<Sent, 64> sent_;  // two thirds of a second at 90 Hz: nobody shows later
  size_t newest_ = 0;
};

}  // namespace viewloom
