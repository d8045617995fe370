// SPDX-License-Identifier: Apache-2.0
#include "web/movie_threads.h"

#include <utility>

#include "base/thread_name.h"

namespace viewloom {

MovieThreads::MovieThreads(uint32_t thread_count) {
  for (uint32_t i = 0; i < thread_count; ++i) {
    threads_.emplace_back([this](const std::stop_token& stop) {
      nameThread("movie");
      serve(stop);
    });
  }
}

MovieThreads::~MovieThreads() {
  for (std::jthread& thread : threads_) thread.request_stop();
  threads_.clear();
}

void MovieThreads::run(std::function<void()> work) {
  std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(work));
  filled_.notify_one();
}

void MovieThreads::serve(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (filled_.wait(lock, stop, [this] { return !waiting_.empty(); })) {
    if (stop.stop_requested()) return;
    const std::function<void()> work = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    work();
    lock.lock();
  }
}

}  // namespace viewloom
