// SPDX-License-Identifier: Apache-2.0
// A clock turned by hand at which one thread can be held up: it waits where it next asks.
#pragma once

#include <pthread.h>

#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "base/clock.h"

namespace viewloom::test {

// Thread-safety: all methods may be called from any thread.
class GateClock final : public Clock {
 public:
  int64_t nowNs() const override {
    std::unique_lock lock(mutex_);
    const std::thread::id caller = std::this_thread::get_id();
    if (!held_name_.empty() && held_name_ == nameOfCaller()) {
      held_name_.clear();
      held_ = caller;
    }
    if (held_ == caller) {
      is_waiting_ = true;
      changed_.notify_all();
      changed_.wait(lock, [&] { return held_ != caller; });
      is_waiting_ = false;
    }
    now_ns_ += per_question_ns_;
    return now_ns_;
  }

  // It may be turned at any time, and wakes nobody.
  std::chrono::nanoseconds napUntil(int64_t) const override { return std::chrono::milliseconds(1); }

  void advance(int64_t by_ns) {
    std::lock_guard lock(mutex_);
    now_ns_ += by_ns;
  }
  // From now on each question takes so long.
  void passAtEachQuestion(int64_t ns) {
    std::lock_guard lock(mutex_);
    per_question_ns_ = ns;
  }
  void hold(std::thread::id thread) {
    std::lock_guard lock(mutex_);
    held_ = thread;
  }
  // The thread of that name that asks for the time next (base/thread_name.h).
  void holdNext(std::string name) {
    std::lock_guard lock(mutex_);
    held_name_ = std::move(name);
  }
  // Until the thread that is held asks for the time; false when it does not in that time.
  bool waitUntilHeld(std::chrono::milliseconds at_most = std::chrono::seconds(30)) const {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, at_most, [this] { return is_waiting_; });
  }
  void letGo() {
    std::lock_guard lock(mutex_);
    held_ = {};
    held_name_.clear();
    changed_.notify_all();
  }

 private:
  static std::string nameOfCaller() {
    std::array<char, 16> name{};  // as long as Linux keeps one
    pthread_getname_np(pthread_self(), name.data(), name.size());
    return name.data();
  }

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  mutable bool is_waiting_ = false;
  mutable std::string held_name_;
  mutable std::thread::id held_;
  mutable int64_t now_ns_ = 1;
  int64_t per_question_ns_ = 0;
};

}  // namespace viewloom::test
