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
// A moment without a single used frame does not yet tell what is used.
constexpr double kFallMost = 0.5;

// In steps of a twentieth, so that the limit does not change all the time.
double rounded(double rate_hz) {
  const double step = std::log(1.05);
  return std::exp(std::round(std::log(rate_hz) / step) * step);
}

}  // namespace

bool UsedRate::note(bool is_used, int64_t now_ns) {
  outcomes_.push_back({now_ns, is_used});
  while (outcomes_.front().time_ns < now_ns - kWindow_ns) outcomes_.pop_front();
  if (outcomes_.size() < kFramesMin && limit_hz_ == 0) return false;
  const int64_t span_ns = now_ns - outcomes_.front().time_ns;
  if (span_ns < kWindow_ns / 2 || now_ns - changed_ns_ < kWindow_ns) return false;
  const auto used_count = double(std::ranges::count_if(outcomes_, &Outcome::is_used));
  const auto count = double(outcomes_.size());
  const double per_second = 1e9 / double(span_ns);
  if (used_count < (1 - kReplacedShareMax) * count) {
    return lower(std::max(used_count * kHeadroom, count * kFallMost) * per_second, now_ns);
  }
  if (limit_hz_ > 0 && used_count == count) return raise(count * per_second, now_ns);
  return false;
}

// Frames at the old limit say nothing about the new one.
void UsedRate::change(double limit_hz, int64_t now_ns) {
  limit_hz_ = limit_hz;
  changed_ns_ = now_ns;
  outcomes_.clear();
}

bool UsedRate::lower(double rate_hz, int64_t now_ns) {
  rise_ = kRise;
  const double before_hz = limit_hz_;
  change(rounded(std::max(rate_hz, kHeadroom)), now_ns);
  return limit_hz_ != before_hz;
}

// A publisher that sends less than it may needs no limit.
bool UsedRate::raise(double received_hz, int64_t now_ns) {
  const bool is_needless = received_hz < limit_hz_ / kRise;
  change(is_needless ? 0 : rounded(limit_hz_ * rise_), now_ns);
  rise_ = is_needless ? kRise : std::min(rise_ * rise_, kRiseMax);
  return true;
}

}  // namespace viewloom
