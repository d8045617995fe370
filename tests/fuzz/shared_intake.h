// SPDX-License-Identifier: Apache-2.0
// The intake of frames for all executions of a target: its threads take long to start.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "base/byte_pool.h"
#include "base/clock.h"
#include "decode/frame_intake.h"
#include "frame/frame_sink.h"

namespace viewloom {

// Hands frames to the sink of the execution that runs. Between executions no frame is under way.
// Thread-safety: none, but for what the intake calls.
class SharedIntake final : public FrameSink {
 public:
  FrameIntake& intake() { return intake_; }
  BytePool& pool() { return pool_; }

  // Frames go to this sink; nullptr = there must be none.
  void serve(FrameSink* sink) {
    std::lock_guard lock(mutex_);
    sink_ = sink;
    holds_ = false;
  }
  // From now on, frames wait.
  void hold() {
    std::lock_guard lock(mutex_);
    holds_ = true;
  }
  void letGo() {
    std::set<std::string> held;
    {
      std::lock_guard lock(mutex_);
      holds_ = false;
      held.swap(held_);
    }
    for (const std::string& stream : held) intake_.resume(stream);
  }
  // Waits until each of the frames that were ever offered was handled, once. At once while frames
  // have to wait.
  void settle(uint64_t offered_count) {
    std::unique_lock lock(mutex_);
    handled_.wait(lock, [&] { return holds_ || handled_count_ == offered_count; });
  }

  bool wantsFrame(const std::string& stream) override {
    std::lock_guard lock(mutex_);
    if (holds_) held_.insert(stream);
    return !holds_;
  }
  void offerFrame(const FrameOrigin& origin, FramePtr frame, ReportFrame report) override {
    FrameSink* sink = nullptr;
    {
      std::lock_guard lock(mutex_);
      sink = sink_;
    }
    sink->offerFrame(origin, std::move(frame), std::move(report));
    noteHandled();
  }
  void noteLost(const std::string&) override { noteHandled(); }
  void forgetStream(const std::string&) override {}

 private:
  void noteHandled() {
    std::lock_guard lock(mutex_);
    ++handled_count_;
    handled_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable handled_;
  uint64_t handled_count_ = 0;  // reported by the sink, refused or replaced
  FrameSink* sink_ = nullptr;
  bool holds_ = false;
  std::set<std::string> held_;  // streams of which a frame waits
  ManualClock clock_;           // stands still
  BytePool pool_{8};
  // Last: its threads use what is above.
  FrameIntake intake_{*this, clock_, pool_, {.on_replaced = [this] { noteHandled(); }}};
};

}  // namespace viewloom
