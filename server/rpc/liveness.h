// SPDX-License-Identifier: Apache-2.0
// Whether the other end of a call lives, and how it learns that this end does: by ticks.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "admission/request_boundary.h"
#include "base/thread_name.h"

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

// Calls a function at regular intervals. Thread-safety: the function is called on a thread of the
// ticker's own, until its destructor.
class Ticker {
 public:
  Ticker(std::chrono::milliseconds interval, std::function<void()> on_tick)
      : thread_([interval, on_tick = std::move(on_tick)](const std::stop_token& stop) {
          nameThread("rpc ticker");
          std::mutex mutex;
          std::condition_variable_any never;
          std::unique_lock lock(mutex);
          while (!never.wait_for(lock, stop, interval, [&] { return stop.stop_requested(); })) {
            try {
              on_tick();
            } catch (const std::exception& thrown) {
              noteThrown("a tick of the calls", thrown);  // they hear of the next one
            }
          }
        }) {}

 private:
  std::jthread thread_;
};

}  // namespace viewloom
