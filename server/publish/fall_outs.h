// SPDX-License-Identifier: Apache-2.0
// How often one reader falls out of chained video.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

namespace viewloom {

// Each time costs all readers of the display a large atlas. Times are monotonic.
// Thread-safety: none.
class FallOuts {
 public:
  static constexpr size_t kTooMany = 4;
  static constexpr int64_t kWindow_ns = 10'000'000'000;

  // It has fallen out so many times by now (AtlasQueue::fallOutCount). True where kTooMany of them
  // lie in the last kWindow_ns, to within the time between calls.
  bool areTooMany(uint64_t count, int64_t now_ns) {
    for (; count_ < count; ++count_) times_ns_.push_back(now_ns);
    while (!times_ns_.empty() && times_ns_.front() < now_ns - kWindow_ns) times_ns_.pop_front();
    return times_ns_.size() >= kTooMany;
  }

  // Those so far do not count any more.
  void forgive() { times_ns_.clear(); }

 private:
  uint64_t count_ = 0;
  std::deque<int64_t> times_ns_;
};

}  // namespace viewloom
