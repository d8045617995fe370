// SPDX-License-Identifier: Apache-2.0
// Asks the server again and again what time it is.
#pragma once

#include <stop_token>
#include <thread>

#include "lib/watcher.h"

namespace viewloom {

// Quickly at first, so that the clock is known at once, then once a second, since clocks drift.
// Thread-safety: none; the watcher outlives it.
class ClockFollower {
 public:
  explicit ClockFollower(Watcher& watcher)
      : thread_([&watcher](const std::stop_token& stop) { run(watcher, stop); }) {}
  // Stop the watcher first: a probe may wait for a network that is not there.
  ~ClockFollower() = default;

 private:
  static void run(Watcher& watcher, const std::stop_token& stop);

  std::jthread thread_;
};

}  // namespace viewloom
