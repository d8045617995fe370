// SPDX-License-Identifier: Apache-2.0
// Pictures that wait for their time; the newest that is due is shown, older ones never are.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace viewloom::show {

// Nanoseconds since 1970, by the clock that publishers on machines with the same time say as well.
inline int64_t wallTimeNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

// A publisher whose clock is further ahead than this has another clock than this machine: its times
// say nothing here, and its pictures are shown at once.
inline constexpr int64_t kAheadMax_ns = 2'000'000'000;

// When a picture is due that came with present_at_ns (0 = at once), at this machine's time.
constexpr int64_t dueTimeNs(int64_t present_at_ns, int64_t now_ns) {
  return present_at_ns > now_ns && present_at_ns - now_ns <= kAheadMax_ns ? present_at_ns : now_ns;
}

// Holds up to three pictures: a decoded quilt may have 200 MB. A fourth takes the oldest one's
// place, and what a newer one overtakes goes: both are counted as dropped.
// Thread-safety: all methods may be called from any thread.
template <typename Picture>
class PresentQueue {
 public:
  void offer(Picture picture, int64_t due_ns) {
    std::lock_guard lock(mutex_);
    if (waiting_.size() == kCapacity) dropFirst();
    waiting_.emplace_back(due_ns, std::move(picture));
  }

  // The newest picture that is due at now_ns, if there is one.
  std::optional<Picture> take(int64_t now_ns) {
    std::lock_guard lock(mutex_);
    size_t due_count = 0;
    for (size_t i = 0; i < waiting_.size(); ++i) {
      if (waiting_[i].first <= now_ns) due_count = i + 1;
    }
    if (due_count == 0) return std::nullopt;
    while (due_count-- > 1) dropFirst();
    std::optional<Picture> picture = std::move(waiting_.front().second);
    waiting_.pop_front();
    return picture;
  }

  // The earliest time at which take() gives something; nothing while the queue is empty.
  std::optional<int64_t> nextDueNs() const {
    std::lock_guard lock(mutex_);
    std::optional<int64_t> next_ns;
    for (const auto& [due_ns, picture] : waiting_) {
      if (!next_ns || due_ns < *next_ns) next_ns = due_ns;
    }
    return next_ns;
  }

  uint64_t droppedCount() const {
    std::lock_guard lock(mutex_);
    return dropped_count_;
  }

 private:
  static constexpr size_t kCapacity = 3;

  void dropFirst() {
    waiting_.pop_front();
    ++dropped_count_;
  }

  mutable std::mutex mutex_;
  std::deque<std::pair<int64_t, Picture>> waiting_;  // in the order in which they came
  uint64_t dropped_count_ = 0;
};

}  // namespace viewloom::show
