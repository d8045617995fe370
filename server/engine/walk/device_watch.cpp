// SPDX-License-Identifier: Apache-2.0
#include "walk/device_watch.h"

#include <utility>

#include "base/thread_name.h"

namespace viewloom {

DeviceWatch::DeviceWatch(const Timeline& timeline,
                         std::function<void(const std::exception& error)> on_failure)
    : timeline_(timeline),
      on_failure_(std::move(on_failure)),
      thread_([this](const std::stop_token& stop) {
        nameThread("device");
        run(stop);
      }) {}

DeviceWatch::~DeviceWatch() {
  drain();
  thread_.request_stop();
}

void DeviceWatch::whenDone(uint64_t value, std::function<void()> then) {
  std::lock_guard lock(mutex_);
  if (has_failed_) return;
  awaited_.push_back({value, std::move(then)});
  added_.notify_one();
}

void DeviceWatch::drain() {
  std::unique_lock lock(mutex_);
  told_.wait(lock, [this] { return awaited_.empty() && !is_telling_; });
}

void DeviceWatch::run(const std::stop_token& stop) {
  try {
    tellAll(stop);
  } catch (const std::exception& error) {
    std::deque<Awaited> dropped;  // let go after the lock
    {
      std::lock_guard lock(mutex_);
      has_failed_ = true;
      dropped.swap(awaited_);
    }
    on_failure_(error);
    dropped.clear();
    std::lock_guard lock(mutex_);
    is_telling_ = false;  // those who drain may go now
    told_.notify_all();
  }
}

void DeviceWatch::tellAll(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (added_.wait(lock, stop, [this] { return !awaited_.empty(); })) {
    Awaited next = std::move(awaited_.front());
    awaited_.pop_front();
    is_telling_ = true;
    lock.unlock();
    timeline_.wait(next.value);
    next.then();
    next.then = nullptr;  // what it holds goes before anybody hears of it
    lock.lock();
    is_telling_ = false;
    told_.notify_all();
  }
}

}  // namespace viewloom
