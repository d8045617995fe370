// SPDX-License-Identifier: Apache-2.0
// Tells when a device has done what was submitted to it, so that nobody who has other work waits.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "gpu/submission.h"

namespace viewloom {

// One thread, which waits for the device. Thread-safety: all methods may be called from any thread.
class DeviceWatch {
 public:
  // `on_failure` is called on the watch's thread when waiting fails; nothing is told afterwards.
  DeviceWatch(const Timeline& timeline,
              std::function<void(const std::exception& error)> on_failure);
  // Drains.
  ~DeviceWatch();

  // `then` is called on the watch's thread once the device has reached the value; in the order of
  // these calls, whose values do not fall.
  void whenDone(uint64_t value, std::function<void()> then);
  // Waits until everything so far is done and told, or has failed.
  void drain();

 private:
  struct Awaited {
    uint64_t value;
    std::function<void()> then;
  };

  void run(const std::stop_token& stop);
  void tellAll(const std::stop_token& stop);

  const Timeline& timeline_;
  const std::function<void(const std::exception& error)> on_failure_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable_any added_;
  std::condition_variable told_;
  std::deque<Awaited> awaited_;
  bool is_telling_ = false;
  bool has_failed_ = false;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace viewloom
