// SPDX-License-Identifier: Apache-2.0
#include "web/movie_threads.h"

#include <new>
#include <utility>

#include "base/thread_name.h"
#include "base/thread_time.h"

namespace viewloom {
namespace {

constexpr double kPxStart_ns = 25;

// An account may lack memory. The work is done all the same, and paid the next time.
template <typename Call>
bool isPaid(const Call& call) {
  try {
    call();
    return true;
  } catch (const std::bad_alloc&) {
    return false;
  }
}

}  // namespace

MovieThreads::MovieThreads(uint32_t thread_count, FairShares& shares, const Metrics& metrics)
    : shares_(shares), metrics_(metrics), px_cost_(kPxStart_ns) {
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

void MovieThreads::run(MovieWork work) {
  shares_.enter(work.claim);
  std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(work));
  filled_.notify_one();
}

void MovieThreads::serve(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (filled_.wait(lock, stop, [this] { return !waiting_.empty(); })) {
    if (stop.stop_requested()) return;
    const MovieWork work = takeNext();
    lock.unlock();
    make(work);
    lock.lock();
  }
}

// With the lock. Without memory to ask for the order, the oldest goes.
MovieWork MovieThreads::takeNext() {
  size_t next = 0;
  isPaid([&] {
    const MovieWork* const chosen =
        shares_.next(waiting_, [](const MovieWork& work) { return &work.claim; });
    next = size_t(chosen - waiting_.data());
  });
  MovieWork work = std::move(waiting_[next]);
  waiting_.erase(waiting_.begin() + std::ptrdiff_t(next));
  return work;
}

void MovieThreads::make(const MovieWork& work) {
  const int64_t predicted_ns = px_cost_.predictNs(work.px_count);
  const bool is_begun = isPaid([&] { shares_.begin(work.claim, predicted_ns); });
  const int64_t begun_ns = threadTimeNs();
  work.work();
  const int64_t measured_ns = threadTimeNs() - begun_ns;
  px_cost_.note(work.px_count, measured_ns);
  metrics_.observeTime(work.claim.payers, measured_ns);
  if (is_begun) isPaid([&] { shares_.finish(work.claim, predicted_ns, measured_ns); });
}

}  // namespace viewloom
