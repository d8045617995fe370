// SPDX-License-Identifier: Apache-2.0
// Signal on which a loop sleeps: something changed, look at everything again.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace viewloom {

// One sleeper; a call while it is awake is remembered. Thread-safety: ring() from any thread.
class WakeUp {
 public:
  void ring() {
    std::lock_guard lock(mutex_);
    rung_ = true;
    rings_.notify_one();
  }

  // Returns without a ring, too, once so much time has passed; empty = never.
  void wait(std::optional<std::chrono::nanoseconds> at_most) {
    std::unique_lock lock(mutex_);
    const auto is_rung = [this] { return rung_; };
    if (at_most) {
      rings_.wait_for(lock, *at_most, is_rung);
    } else {
      rings_.wait(lock, is_rung);
    }
    rung_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable rings_;
  bool rung_ = false;
};

}  // namespace viewloom
