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

void EncodeQueue::push(TracedStrip strip) {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [this] { return is_closed_ || strips_.size() < strip_count_max_; });
  if (is_closed_) return;
  const auto later = std::find_if(strips_.begin(), strips_.end(), [&](const TracedStrip& other) {
    return other.run->picture->gathers_on_host && goesFirst(*strip.run, *other.run);
  });
  strips_.insert(later, std::move(strip));
  noteFilled();
}

void EncodeQueue::push(SweepRunPtr sweep) {
  std::lock_guard lock(mutex_);
  if (is_closed_) return;
  const auto later = std::find_if(sweeps_.begin(), sweeps_.end(), [&](const SweepRunPtr& other) {
    return goesFirst(*sweep->run(), *other->run());
  });
  sweeps_.insert(later, std::move(sweep));
  noteFilled();
}

void EncodeQueue::resume(TracedStrip strip) {
  std::lock_guard lock(mutex_);
  // What stands before those goes, too: that is only packed.
  const auto sooner = std::find_if(strips_.rbegin(), strips_.rend(), [&](const auto& other) {
    return goesFirst(*other.run, *strip.run);
  });
  strips_.insert(sooner.base(), std::move(strip));
  noteFilled();
}

// Whoever takes something wakes the next thread for what is left, from where it runs itself. Woken
// all at once, two threads were put on one core of two in every fifth atlas, and stayed there for
// as long as it took.
std::optional<EncodeTask> EncodeQueue::pop() {
  std::unique_lock lock(mutex_);
  std::optional<EncodeTask> task;
  while (!(task = take())) {
    if (is_closed_ && sweeps_.empty()) return std::nullopt;
    waitForMore(lock);
  }
  const bool is_more = nextSweep() || !strips_.empty();
  const bool is_over = is_closed_ && sweeps_.empty() && strips_.empty();
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
  if (const SweepRunPtr sweep = nextSweep()) return EncodeTask{{}, takePart(sweep)};
  if (strips_.empty()) return std::nullopt;
  EncodeTask task{std::move(strips_.front()), {}};
  strips_.pop_front();
  room_.notify_one();
  return task;
}

// The sweep that the next part is of: the first that has one to hand out, or the first of others
// if that is their turn. nullptr = a strip goes before it, or it is the turn of that, or there is
// none.
SweepRunPtr EncodeQueue::nextSweep() const {
  SweepRunPtr first, other;
  for (const SweepRunPtr& sweep : sweeps_) {
    if (!sweep->hasPart()) continue;
    if (!first) first = sweep;
    if (sweep->run()->isTracked()) continue;
    other = sweep;
    break;
  }
  const AtlasRunPtr strip = strips_.empty() ? nullptr : strips_.front().run;
  const bool is_sweep = first && (!strip || goesFirst(*first->run(), *strip));
  const AtlasRunPtr next = is_sweep ? first->run() : strip;
  if (next && next->isTracked() && turn_.isOver()) {
    if (other) return other;
    if (strip && !strip->isTracked()) return nullptr;
  }
  return is_sweep ? first : nullptr;
}

SweepPart EncodeQueue::takePart(const SweepRunPtr& sweep) {
  SweepPart part{.sweep = sweep};
  if (sweep->next_piece < sweep->pieceCount()) {
    part.index = sweep->next_piece++;
    return part;
  }
  part.is_strip = true;
  part.index = sweep->next_strip++;
  if (sweep->next_strip == sweep->run()->stripCount()) std::erase(sweeps_, sweep);
  return part;
}

void EncodeQueue::noteSwept(SweepRun& sweep) {
  std::lock_guard lock(mutex_);
  if (++sweep.swept_count == sweep.pieceCount()) noteFilled();
}

void EncodeQueue::noteServed(bool is_tracked, int64_t duration_ns) {
  std::lock_guard lock(mutex_);
  turn_.note(is_tracked, duration_ns);
}

void EncodeQueue::close() {
  std::lock_guard lock(mutex_);
  is_closed_ = true;
  room_.notify_all();
  ++fill_count_;
  filled_.notify_all();
}

void EncodeQueue::clear() {
  std::deque<TracedStrip> strips;  // let go after the lock
  std::vector<SweepRunPtr> sweeps;
  std::lock_guard lock(mutex_);
  strips.swap(strips_);
  sweeps.swap(sweeps_);
  ++fill_count_;
  filled_.notify_all();
}

}  // namespace viewloom
