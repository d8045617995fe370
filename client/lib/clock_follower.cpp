// SPDX-License-Identifier: Apache-2.0
#include "lib/clock_follower.h"

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace viewloom {
namespace {

constexpr std::chrono::milliseconds kFirstPause(50);
constexpr std::chrono::milliseconds kPause(1000);
constexpr size_t kFirstCount = ServerClock::kProbeCount;

}  // namespace

void ClockFollower::run(Watcher& watcher, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  for (size_t count = 0; !stop.stop_requested(); ++count) {
    watcher.probeClock();
    stopped.wait_for(lock, stop, count < kFirstCount ? kFirstPause : kPause, [] { return false; });
  }
}

}  // namespace viewloom
