// SPDX-License-Identifier: Apache-2.0
// Whether the other end of a call lives, and how it learns that this end does.
#pragma once

#include <chrono>
#include <cstdint>

namespace viewloom {

// Counted in ticks instead of time: a server that was stopped for a while has heard nobody, and is
// nobody's fault.
inline constexpr std::chrono::milliseconds kTick{250};
inline constexpr uint32_t kHeartbeatTicks = 4;  // 1 s
inline constexpr uint32_t kSilenceTicks = 20;   // 5 s
inline constexpr int kSilence_s = 5;

// Counts the ticks since something happened. Thread-safety: none.
class TicksSince {
 public:
  void restart() { count_ = 0; }
  // Another tick. True from the `limit`th one on.
  bool reaches(uint32_t limit) { return ++count_ >= limit; }

 private:
  uint32_t count_ = 0;
};

}  // namespace viewloom
