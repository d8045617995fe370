// SPDX-License-Identifier: Apache-2.0
// When the next frame may be sent, at the rate at which the server uses frames.
#pragma once

#include <algorithm>
#include <cstdint>

namespace viewloom {

// Thread-safety: none.
class SendPace {
 public:
  // Frames a second that are used; 0 = all.
  void setRate(double rate_hz) {
    interval_ns_ = rate_hz > 0 ? int64_t(1e9 / std::max(rate_hz, kRateMin_hz)) : 0;
  }
  // A frame is sent now. If it comes a little late, the next one need not.
  void note(int64_t now_ns) {
    const int64_t late_ns = now_ns - dueNs();
    sent_ns_ = late_ns < interval_ns_ / 2 ? now_ns - std::max<int64_t>(late_ns, 0) : now_ns;
  }
  // When the next frame may be sent.
  int64_t dueNs() const { return sent_ns_ + interval_ns_; }

 private:
  static constexpr double kRateMin_hz = 0.1;

  int64_t interval_ns_ = 0;
  int64_t sent_ns_ = 0;
};

}  // namespace viewloom
