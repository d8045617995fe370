// SPDX-License-Identifier: Apache-2.0
#include "pipeline/encode_queue.h"

#include <algorithm>
#include <utility>

namespace viewloom {

void EncodeQueue::push(TracedStrip strip) {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [this] { return is_closed_ || strips_.size() < strip_count_max_; });
  if (is_closed_) return;
  strips_.push_back(std::move(strip));
  filled_.notify_one();
}

void EncodeQueue::push(SweepRunPtr sweep) {
  std::lock_guard lock(mutex_);
  if (is_closed_) return;
  const auto later = std::find_if(sweeps_.begin(), sweeps_.end(), [&](const SweepRunPtr& other) {
    return other->deadlineNs() > sweep->deadlineNs();
  });
  sweeps_.insert(later, std::move(sweep));
  filled_.notify_all();
}

std::optional<EncodeTask> EncodeQueue::pop() {
  std::unique_lock lock(mutex_);
  while (true) {
    SweepPart part = takePart();
    if (part.sweep) return EncodeTask{{}, std::move(part)};
    if (!strips_.empty()) {
      EncodeTask task{std::move(strips_.front()), {}};
      strips_.pop_front();
      room_.notify_one();
      return task;
    }
    if (is_closed_ && sweeps_.empty()) return std::nullopt;
    filled_.wait(lock);
  }
}

// Of the soonest sweep that has any and is due before the strips; one that is being swept to its
// end has none.
SweepPart EncodeQueue::takePart() {
  for (auto sweep = sweeps_.begin(); sweep != sweeps_.end(); ++sweep) {
    if (!strips_.empty() && strips_.front().run->job.deadline_ns <= (*sweep)->deadlineNs()) break;
    SweepPart part{.sweep = *sweep};
    SweepRun& run = **sweep;
    if (run.next_piece < run.pieceCount()) {
      part.index = run.next_piece++;
      return part;
    }
    if (run.swept_count < run.pieceCount()) continue;
    part.is_strip = true;
    part.index = run.next_strip++;
    if (run.next_strip == run.run()->stripCount()) sweeps_.erase(sweep);
    return part;
  }
  return {};
}

void EncodeQueue::noteSwept(SweepRun& sweep) {
  std::lock_guard lock(mutex_);
  if (++sweep.swept_count == sweep.pieceCount()) filled_.notify_all();
}

void EncodeQueue::close() {
  std::lock_guard lock(mutex_);
  is_closed_ = true;
  room_.notify_all();
  filled_.notify_all();
}

void EncodeQueue::clear() {
  std::deque<TracedStrip> strips;  // let go after the lock
  std::vector<SweepRunPtr> sweeps;
  std::lock_guard lock(mutex_);
  strips.swap(strips_);
  sweeps.swap(sweeps_);
  filled_.notify_all();
}

}  // namespace viewloom
