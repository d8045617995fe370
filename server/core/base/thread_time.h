// SPDX-License-Identifier: Apache-2.0
// Clocks that work is measured with. Nobody turns them by hand: no client is told these times.
#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>

namespace viewloom {

inline int64_t timeOfClockNs(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// Nanoseconds since the calling thread began that it has had a core for. Unlike a wall clock it
// stands while others have the core, so it tells what work costs on a machine that is busy.
inline int64_t threadTimeNs() {
  return timeOfClockNs(CLOCK_THREAD_CPUTIME_ID);
}

// The same of all threads of this process together.
inline int64_t processTimeNs() {
  return timeOfClockNs(CLOCK_PROCESS_CPUTIME_ID);
}

// Nanoseconds since an arbitrary start, for work of several threads or of a device.
inline int64_t wallTimeNs() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::nanoseconds(now).count();
}

}  // namespace viewloom
