// SPDX-License-Identifier: Apache-2.0
#include "schedule/moving_heads.h"

#include <algorithm>

namespace viewloom {
namespace {

// Poses that nothing has followed for so many of their intervals are taken to be the last.
constexpr int64_t kIntervalsToSilence = 2;

}  // namespace

void MovingHeads::add(const PoseTimes& poses) {
  ++count_;
  newest_ns_ = std::max(newest_ns_, poses.received_ns);
  if (const auto due_ns = nextDueNs(poses)) {
    soonest_due_ns_ = std::min(soonest_due_ns_, *due_ns);
  }
}

bool MovingHeads::areTimely(const PoseTimes& poses) const {
  if (areFresh(poses)) return true;
  const auto due_ns = nextDueNs(poses);
  return due_ns && *due_ns - now_ns_ < kAwaited_ns &&
         2 * (*due_ns - now_ns_) * count_ < poses.interval_ns;
}

bool MovingHeads::areAtHand(const PoseTimes& poses) const {
  const auto due_ns = nextDueNs(poses);
  return areFresh(poses) || !due_ns || *due_ns - now_ns_ < kAwaited_ns;
}

bool MovingHeads::areNewest(const PoseTimes& poses) const {
  return poses.received_ns >= newest_ns_ - kAlikePoses_ns;
}

std::optional<int64_t> MovingHeads::waitForUntilNs(const PoseTimes& poses) const {
  if (areFresh(poses)) return std::nullopt;
  return waitUntilNs(nextDueNs(poses), kAwaited_ns);
}

std::optional<int64_t> MovingHeads::waitForAnyUntilNs() const {
  const int64_t age_ns = now_ns_ - newest_ns_;
  if (age_ns <= kAlikePoses_ns) return std::nullopt;
  if (soonest_due_ns_ == kNever_ns) return std::nullopt;
  return waitUntilNs(soonest_due_ns_, std::min(age_ns, kAnyAwaited_ns));
}

bool MovingHeads::areFresh(const PoseTimes& poses) const {
  const int64_t age_ns = now_ns_ - poses.received_ns;
  return poses.interval_ns <= 0 || age_ns <= kAlikePoses_ns ||
         2 * age_ns * count_ < poses.interval_ns ||
         age_ns > kIntervalsToSilence * poses.interval_ns;
}

// Empty if nothing says so, or they did not come.
std::optional<int64_t> MovingHeads::nextDueNs(const PoseTimes& poses) const {
  const int64_t due_ns = poses.received_ns + poses.interval_ns;
  if (poses.interval_ns <= 0 || now_ns_ >= due_ns + kAlikePoses_ns) return std::nullopt;
  return due_ns;
}

std::optional<int64_t> MovingHeads::waitUntilNs(std::optional<int64_t> due_ns,
                                                int64_t at_most_ns) const {
  if (!due_ns || *due_ns - now_ns_ >= at_most_ns) return std::nullopt;
  return *due_ns + kAlikePoses_ns;
}

}  // namespace viewloom
