// SPDX-License-Identifier: Apache-2.0
// How fast messages of one client are read.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace viewloom {

// Rate at which one client may send, over a longer time. A page sends one message for each atlas,
// of which there are at most 240 a second, and some for what its visitor does.
struct MessageRate {
  double messages_per_s = 500;
  double bytes_per_s = 1 << 20;
  int64_t burst_ns = 1'000'000'000;  // what a client may be ahead, in the time that it would take
};

// Reading a flood slowly leaves the rest of it with its sender, and costs others nothing. Nothing
// is refused or lost. Thread-safety: none.
class MessagePace {
 public:
  explicit MessagePace(const MessageRate& rate) : rate_(rate) {}

  // Notes a message of that size. Returns the time to wait before the next one is read; 0 = none.
  int64_t delayNs(int64_t now_ns, size_t bytes) {
    constexpr double kNsPerSecond = 1e9;
    const double seconds =
        1 / rate_.messages_per_s + static_cast<double>(bytes) / rate_.bytes_per_s;
    paid_ns_ = std::max(paid_ns_, now_ns) + static_cast<int64_t>(seconds * kNsPerSecond);
    return std::max<int64_t>(paid_ns_ - now_ns - rate_.burst_ns, 0);
  }

 private:
  const MessageRate rate_;
  int64_t paid_ns_ = 0;  // when all messages so far would have come, at that rate
};

}  // namespace viewloom
