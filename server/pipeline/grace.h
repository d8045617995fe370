// SPDX-License-Identifier: Apache-2.0
// Time that something has before it is ended.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include "admission/request_boundary.h"
#include "base/thread_name.h"

namespace viewloom {

// Calls something after a time, on a thread of its own, unless it is destroyed by then.
// Thread-safety: none.
class Grace {
 public:
  Grace(std::chrono::nanoseconds time, std::function<void()> then)
      : thread_([this, time, then = std::move(then)](const std::stop_token& stop) {
          nameThread("grace");
          std::unique_lock lock(mutex_);
          over_.wait_for(lock, stop, time, [] { return false; });
          if (stop.stop_requested()) return;
          try {
            then();
          } catch (const std::exception& thrown) {
            noteThrown("the end of a grace", thrown);
          }
        }) {}

 private:
  std::mutex mutex_;
  std::condition_variable_any over_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace viewloom
