// SPDX-License-Identifier: Apache-2.0
// Threads that encode live videos, apart from those that serve connections.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "base/cost_estimate.h"
#include "metrics/metrics.h"
#include "schedule/fair_shares.h"

namespace viewloom {

// One picture of one video.
struct MovieWork {
  Claim claim;
  uint64_t px_count = 0;       // of the atlas
  std::function<void()> work;  // must not throw
};

// Work goes in fair shares, and is paid like that of engines. Each player has one piece of work
// here at a time, which bounds the queue. Thread-safety: run() may be called from any thread.
class MovieThreads {
 public:
  // Shares and metrics outlive it.
  MovieThreads(uint32_t thread_count, FairShares& shares, const Metrics& metrics);
  // Work that has not begun is dropped.
  ~MovieThreads();
  MovieThreads(const MovieThreads&) = delete;
  MovieThreads& operator=(const MovieThreads&) = delete;

  void run(MovieWork work);

 private:
  void serve(const std::stop_token& stop);
  MovieWork takeNext();
  void make(const MovieWork& work);

  FairShares& shares_;
  const Metrics& metrics_;
  CostEstimate px_cost_;
  std::mutex mutex_;
  std::condition_variable_any filled_;
  std::vector<MovieWork> waiting_;
  std::vector<std::jthread> threads_;  // last: they use the rest
};

}  // namespace viewloom
