// SPDX-License-Identifier: Apache-2.0
#include "rpc/used_rate.h"

#include <algorithm>
#include <cmath>

namespace viewloom {
namespace {

constexpr int64_t kWindow_ns = 2'000'000'000;
// Fewer frames tell nothing.
constexpr size_t kFramesMin = 8;
// A stream may lose so many of its frames: publishers and displays have no common beat.
constexpr double kReplacedShareMax = 0.1;
// Beyond what is used, so that more can be used when there is time.
constexpr double kHeadroom = 1.1;
constexpr double kRiseMax = 4;
// A publisher is held back whose frames wait for so much of the time, in so many turns at least. It
// may send more while they wait for less than the other share: their number grows slowly.
constexpr double kWaitedShareMax = 0.75;
constexpr double kWaitedShareCalm = 0.25;
constexpr size_t kTurnsMin = 3;
constexpr int64_t kTurnsWindow_ns = 3'000'000'000;
// Then the frames that wait, also those on their way, become fewer.
constexpr double kRelief = 0.9;
// The least that a publisher that is held back is asked for. A waiting frame is built unasked after
// that time (kHeldFrame_ns), and publishers that obey send no fewer.
constexpr double kHeldBackMin_hz = 0.1;
// A window holds that many frames of a publisher at its limit, so that its rate can be told.
constexpr double kFramesInWindow = 2.5;
// So long after a change, turns tell how much room there is. A publisher that sends fewer of the
// frames that it may is not limited.
constexpr int64_t kLeapAfter_ns = 500'000'000;
constexpr double kLimitedShare = 0.8;
// A moment without a single used frame does not yet tell what is used.
constexpr double kFallMost = 0.5;

// In steps of a twentieth, so that the limit does not change all the time.
double rounded(double rate_hz) {
  const double step = std::log(1.05);
  return std::exp(std::round(std::log(rate_hz) / step) * step);
}

// Keeps the newest `count_min` whatever their age.
template <typename Events>
void keepSince(int64_t time_ns, size_t count_min, Events& events) {
  while (events.size() > count_min && events.front().time_ns < time_ns) events.pop_front();
}

}  // namespace

bool UsedRate::note(bool is_used, int64_t now_ns) {
  outcomes_.push_back({now_ns, is_used});
  return judge(now_ns);
}

bool UsedRate::noteTurn(int64_t waited_ns, int64_t now_ns) {
  turns_.push_back({now_ns, waited_ns});
  return judge(now_ns);
}

bool UsedRate::judge(int64_t now_ns) {
  keepSince(now_ns - windowNs(), 0, outcomes_);
  keepSince(now_ns - kTurnsWindow_ns, kTurnsMin, turns_);
  if (leap(now_ns)) return true;
  if (now_ns - changed_ns_ < kWindow_ns) return false;
  if (const double held_back_hz = heldBackHz(); held_back_hz > 0) {
    return lower(std::max(held_back_hz * kRelief, kHeldBackMin_hz), now_ns);
  }
  if (outcomes_.empty() || (outcomes_.size() < kFramesMin && limit_hz_ == 0)) return false;
  const int64_t span_ns = now_ns - outcomes_.front().time_ns;
  if (span_ns < kWindow_ns / 2) return false;
  const auto used_count = double(std::ranges::count_if(outcomes_, &Outcome::is_used));
  const auto count = double(outcomes_.size());
  const double per_second = 1e9 / double(span_ns);
  if (used_count < (1 - kReplacedShareMax) * count) {
    const double used_hz = std::max(used_count * kHeadroom, count * kFallMost) * per_second;
    const double rate_hz = std::max(used_hz, kHeadroom);
    return lower(limit_hz_ > 0 ? std::min(rate_hz, limit_hz_) : rate_hz, now_ns);
  }
  const bool is_calm = turns_.empty() || waitedShare() < kWaitedShareCalm;
  if (limit_hz_ > 0 && used_count == count && is_calm) return raise(count * per_second, now_ns);
  return false;
}

int64_t UsedRate::windowNs() const {
  if (limit_hz_ == 0) return kWindow_ns;
  return std::max(kWindow_ns, int64_t(kFramesInWindow * 1e9 / limit_hz_));
}

// Share of the time in which a frame waited for its turn. As good as all while that is not known.
double UsedRate::waitedShare() const {
  int64_t waited_ns = 0;
  for (size_t i = 1; i < turns_.size(); ++i) waited_ns += turns_[i].waited_ns;
  const int64_t span_ns = turns_.back().time_ns - turns_.front().time_ns;
  return span_ns > 0 ? double(waited_ns) / double(span_ns) : 1;
}

// Turns a second of a publisher that is held back; 0 = it is not.
double UsedRate::heldBackHz() const {
  if (turns_.size() < kTurnsMin || waitedShare() < kWaitedShareMax) return 0;
  const int64_t span_ns = turns_.back().time_ns - turns_.front().time_ns;
  return span_ns < kWindow_ns / 2 ? 0 : double(turns_.size() - 1) * 1e9 / double(span_ns);
}

// Frames at the old limit say nothing about the new one.
void UsedRate::change(double limit_hz, int64_t now_ns) {
  limit_hz_ = limit_hz;
  changed_ns_ = now_ns;
  outcomes_.clear();
  turns_.clear();
}

bool UsedRate::lower(double rate_hz, int64_t now_ns) {
  rise_ = kRise;
  if (has_leapt_) may_leap_ = false;
  const double before_hz = limit_hz_;
  change(rounded(rate_hz), now_ns);
  return limit_hz_ != before_hz;
}

// A publisher that sends less than it may needs no limit.
bool UsedRate::raise(double received_hz, int64_t now_ns) {
  const bool is_needless = received_hz < limit_hz_ / kRise;
  change(is_needless ? 0 : rounded(limit_hz_ * rise_), now_ns);
  rise_ = is_needless ? kRise : std::min(rise_ * rise_, kRiseMax);
  if (is_needless) may_leap_ = true;
  return true;
}

// To so many times the frames that they would wait for the share of the time that is still calm.
bool UsedRate::leap(int64_t now_ns) {
  const int64_t span_ns = now_ns - changed_ns_;
  const double span_s = 1e-9 * double(span_ns);
  if (limit_hz_ == 0 || !may_leap_ || span_ns < kLeapAfter_ns) return false;
  if (double(turns_.size()) < kLimitedShare * limit_hz_ * span_s) return false;
  int64_t waited_ns = 0;
  for (const Turn& turn : turns_) waited_ns += turn.waited_ns;
  const double share = double(waited_ns) / double(span_ns);
  if (share >= kWaitedShareCalm) return false;
  has_leapt_ = true;
  change(rounded(limit_hz_ * kWaitedShareCalm / std::max(share, kWaitedShareCalm / kRiseMax)),
         now_ns);
  return true;
}

}  // namespace viewloom
