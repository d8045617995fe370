// SPDX-License-Identifier: Apache-2.0
// Monotonic time in nanoseconds, and a clock that tests set by hand.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>

namespace viewloom {

// Thread-safety: all methods may be called from any thread.
class Clock {
 public:
  virtual ~Clock() = default;
  // Nanoseconds since an arbitrary start; never goes back.
  virtual int64_t nowNs() const = 0;
  // Longest time that a thread may sleep before it checks this time again.
  virtual std::chrono::nanoseconds napUntil(int64_t due_ns) const = 0;
};

class SteadyClock final : public Clock {
 public:
  int64_t nowNs() const override {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
  std::chrono::nanoseconds napUntil(int64_t due_ns) const override {
    return std::chrono::nanoseconds(std::max(due_ns - nowNs(), int64_t{0}));
  }
};

class ManualClock final : public Clock {
 public:
  int64_t nowNs() const override { return now_ns_; }
  // A test may set the clock at any time; this wakes nobody.
  std::chrono::nanoseconds napUntil(int64_t) const override { return std::chrono::milliseconds(1); }
  void advance(int64_t by_ns) { now_ns_ += by_ns; }

 private:
  std::atomic<int64_t> now_ns_{1};
};

}  // namespace viewloom
