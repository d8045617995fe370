// SPDX-License-Identifier: Apache-2.0
// Threads that encode live videos, apart from those that serve connections.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace viewloom {

// Work is done in the order in which it comes, so that all players take turns. Each player has one
// piece of work here at a time, which bounds the queue. Thread-safety: run() may be called from any
// thread.
class MovieThreads {
 public:
  explicit MovieThreads(uint32_t thread_count);
  // Work that has not begun is dropped.
  ~MovieThreads();
  MovieThreads(const MovieThreads&) = delete;
  MovieThreads& operator=(const MovieThreads&) = delete;

  // `work` must not throw.
  void run(std::function<void()> work);

 private:
  void serve(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any filled_;
  std::deque<std::function<void()>> waiting_;
  std::vector<std::jthread> threads_;  // last: they use the rest
};

}  // namespace viewloom
