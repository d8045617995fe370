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

// Who looks out sees it, also if it is about to sleep.
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

template <typename Counts>
StripBatchPtr EncodeQueue::first(const Counts& counts) const {
  StripBatchPtr first;
  for (const StripBatchPtr& batch : batches_) {
    if (!batch->hasPart() || !counts(*batch->run)) continue;
    if (!first || goesFirstAtWork(*batch->run, *first->run)) first = batch;
  }
  return first;
}

// The batch that the next part is of: the first that has one to hand out, or the first of those
// that would wait for it, if that is their turn. nullptr = there is none. Batches of one atlas keep
// their order.
StripBatchPtr EncodeQueue::next() const {
  const StripBatchPtr first_of_all = first([](const AtlasRun&) { return true; });
  if (!first_of_all || first_of_all->run->isLongWork()) return first_of_all;
  StripBatchPtr other;
  if (first_of_all->run->isTracked()) {
    if (eyes_turn_.isOver()) other = first([](const AtlasRun& run) { return !run.isTracked(); });
  } else if (short_turn_.isOver()) {
    other = first([](const AtlasRun& run) { return run.isLongWork(); });
  }
  return other ? other : first_of_all;
}

void EncodeQueue::noteMade(StripBatch& batch) {
  std::lock_guard lock(mutex_);
  if (++batch.made_count == batch.work->shape.piece_count) noteFilled();
}

void EncodeQueue::noteServed(AtlasRun& run, int64_t duration_ns) {
  std::lock_guard lock(mutex_);
  eyes_turn_.note(run.isTracked(), duration_ns);
  if (!run.isTracked()) short_turn_.note(!run.isLongWork(), duration_ns);
  run.worked_ns += duration_ns;
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
