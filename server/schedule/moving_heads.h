// SPDX-License-Identifier: Apache-2.0
// Heads that wait for an answer: whose poses are fresh, and whose are worth a wait.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "eye_poses/eye_track.h"

namespace viewloom {

// Poses that came so close together are as good as each other, however fast they come: a small part
// of the interval of any headset. Poses that are due may be late by as much.
inline constexpr int64_t kAlikePoses_ns = 500'000;

// So soon poses must be due for a wait, as all heads wait for them. Of the head whose turn it is:
// half of an interval at 60 Hz.
inline constexpr int64_t kAwaited_ns = 8'000'000;
// Limit for anybody's pose: more than the usual gap between the poses of a few heads. It is short
// enough to leave time for a second answer if all heads move at once.
inline constexpr int64_t kAnyAwaited_ns = 3'000'000;

// At one instant. Thread-safety: none.
class MovingHeads {
 public:
  explicit MovingHeads(int64_t now_ns) : now_ns_(now_ns) {}

  void add(const PoseTimes& poses);

  int64_t count() const { return count_; }
  // Whether a pose of about one of n heads is awaited. Its poses came within half an nth of their
  // interval or within kAlikePoses_ns, or are due in half an nth and in less than kAwaited_ns.
  // Heads without a next pose, because none came before or for two intervals, are always timely.
  bool areTimely(const PoseTimes& poses) const;
  // They came as late as that, or are due in less than kAwaited_ns, or late.
  bool areAtHand(const PoseTimes& poses) const;
  // They came within kAlikePoses_ns of the newest of all.
  bool areNewest(const PoseTimes& poses) const;

  // By when nobody waits any more for the next poses of a head; empty = its are fresh, or the next
  // are not due in less than kAwaited_ns: begin.
  std::optional<int64_t> waitForUntilNs(const PoseTimes& poses) const;
  // The same of whoever's come next, if they are due in less than kAnyAwaited_ns and in less time
  // than the newest of all have aged: an answer begins later by less than it saves in age.
  std::optional<int64_t> waitForAnyUntilNs() const;

 private:
  static constexpr int64_t kNever_ns = std::numeric_limits<int64_t>::max();

  bool areFresh(const PoseTimes& poses) const;
  std::optional<int64_t> nextDueNs(const PoseTimes& poses) const;
  std::optional<int64_t> waitUntilNs(std::optional<int64_t> due_ns, int64_t at_most_ns) const;

  int64_t now_ns_;
  int64_t count_ = 0;
  int64_t newest_ns_ = 0;               // when the newest of all poses came
  int64_t soonest_due_ns_ = kNever_ns;  // the next poses of all
};

}  // namespace viewloom
