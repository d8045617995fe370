// SPDX-License-Identifier: Apache-2.0
// Calls a function at regular intervals.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "base/thread_name.h"

namespace viewloom {

// Thread-safety: the function is called on a thread of the ticker's own, until its destructor.
class Ticker {
 public:
  Ticker(std::chrono::milliseconds interval, std::function<void()> on_tick)
      : thread_([interval, on_tick = std::move(on_tick)](const std::stop_token& stop) {
          nameThread("rpc ticker");
          std::mutex mutex;
          std::condition_variable_any never;
          std::unique_lock lock(mutex);
          while (!never.wait_for(lock, stop, interval, [&] { return stop.stop_requested(); })) {
            on_tick();
          }
        }) {}

 private:
  std::jthread thread_;
};

}  // namespace viewloom
