// SPDX-License-Identifier: Apache-2.0
#include "pipeline/encode_queue.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace viewloom {
namespace {

// To be woken takes a thread about as long, and it may be put on a core that is busy.
constexpr std::chrono::microseconds kLookout{100};

}  // namespace

void EncodeQueue::push(StripBatchPtr batch) {
  std::lock_guard lock(mutex_);
  if (is_closed_) return;
  batches_.push_back(std::move(batch));
  noteFilled();
}

// Whoever takes something wakes the next thread for what is left, from where it runs itself. Woken
// all at once, two threads were put on one core of two in every fifth atlas, and stayed there for
// as long as it took.
std::optional<EncodeTask> EncodeQueue::pop() {
  std::unique_lock lock(mutex_);
  std::optional<EncodeTask> task;
  while (!(task = take())) {
    if (is_closed_ && batches_.empty()) return std::nullopt;
    waitForMore(lock);
  }
  const bool is_more = next() != nullptr;
  const bool is_over = is_closed_ && batches_.empty();
  lock.unlock();
  if (is_over)
    filled_.notify_all();
  else if (is_more)
    filled_.notify_one();
  return task;
}

// Between two pieces, strips or answers it is often not for long.
void EncodeQueue::waitForMore(std::unique_lock<std::mutex>& lock) {
  const uint32_t seen_count = fill_count_;
  ++lookout_count_;
  lock.unlock();
  const auto end = std::chrono::steady_clock::now() + kLookout;
  while (fill_count_ == seen_count && std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
  }
  lock.lock();
  --lookout_count_;
  if (fill_count_ == seen_count) filled_.wait(lock);
}

// A thread that looks sees it, even if it is about to sleep.
void EncodeQueue::noteFilled() {
  ++fill_count_;
  if (lookout_count_ == 0) filled_.notify_one();
}

std::optional<EncodeTask> EncodeQueue::take() {
  StripBatchPtr batch = next();
  if (!batch) return std::nullopt;
  EncodeTask task{.batch = batch};
  if (batch->next_piece < batch->work->shape.piece_count) {
    task.index = batch->next_piece++;
    return task;
  }
  task.is_strip = true;
  task.index = batch->next_strip++;
  if (batch->next_strip == batch->work->shape.strip_count) std::erase(batches_, batch);
  return task;
}

StripBatchPtr EncodeQueue::next() const {
  const auto line = turns_.lineUp(batches_, [](const StripBatchPtr& batch) {
    return batch->hasPart() ? &batch->run->at_work : nullptr;
  });
  const StripBatchPtr* const next = line.in_turn != nullptr ? line.in_turn : line.first;
  return next == nullptr ? nullptr : *next;
}

void EncodeQueue::noteMade(StripBatch& batch) {
  std::lock_guard lock(mutex_);
  if (++batch.made_count == batch.work->shape.piece_count) noteFilled();
}

void EncodeQueue::noteServed(AtlasRun& run, int64_t duration_ns) {
  std::lock_guard lock(mutex_);
  turns_.note(run.at_work, duration_ns);
}

void EncodeQueue::close() {
  std::lock_guard lock(mutex_);
  is_closed_ = true;
  ++fill_count_;
  filled_.notify_all();
}

void EncodeQueue::clear() {
  std::vector<StripBatchPtr> batches;  // let go after the lock
  std::lock_guard lock(mutex_);
  batches.swap(batches_);
  ++fill_count_;
  filled_.notify_all();
}

}  // namespace viewloom
