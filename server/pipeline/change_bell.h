// SPDX-License-Identifier: Apache-2.0
// Signal on which several threads sleep: something changed, look at everything again.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <stop_token>

namespace viewloom {

// Whoever looks notes the count before, and then waits for a change since. Takes no other lock, so
// it may be rung from anywhere. Thread-safety: all methods may be called from any thread.
class ChangeBell {
 public:
  void ring() {
    std::lock_guard lock(mutex_);
    ++count_;
    rings_.notify_all();
  }

  uint64_t count() {
    std::lock_guard lock(mutex_);
    return count_;
  }

  // Returns when it was rung since the count was that, or is to stop, or so much time has passed.
  void waitForChange(uint64_t seen_count, const std::stop_token& stop,
                     std::optional<std::chrono::nanoseconds> time) {
    const auto hasChanged = [&] { return count_ != seen_count; };
    std::unique_lock lock(mutex_);
    if (time) {
      rings_.wait_for(lock, stop, *time, hasChanged);
    } else {
      rings_.wait(lock, stop, hasChanged);
    }
  }

 private:
  std::mutex mutex_;
  std::condition_variable_any rings_;
  uint64_t count_ = 0;
};

}  // namespace viewloom
