// SPDX-License-Identifier: Apache-2.0
// Signal on which a loop sleeps: something changed, look at everything again.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
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

  void wait() {
    std::unique_lock lock(mutex_);
    rings_.wait(lock, [this] { return rung_; });
    rung_ = false;
  }

  // Returns without a ring, too, once so much time has passed.
  void waitFor(std::chrono::nanoseconds time) {
    std::unique_lock lock(mutex_);
    rings_.wait_for(lock, time, [this] { return rung_; });
    rung_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable rings_;
  bool rung_ = false;
};

}  // namespace viewloom
