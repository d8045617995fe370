// SPDX-License-Identifier: Apache-2.0
#include "publish/quality_rung.h"

#include <algorithm>
#include <cmath>

namespace viewloom {
namespace {

constexpr uint32_t kStepQp = 4;
// Bytes at a step, by those at the finer one (Portrait quilts at QP 22 to 38: 0.65 to 0.69).
constexpr double kStepBytes = 0.68;
constexpr int64_t kRungWindow_ns = 1'000'000'000;
constexpr size_t kBegunMax = 256;
constexpr double kNewestWeight = 0.3;
// Share of the line that a step may take: the one that is used, and one to go to.
constexpr double kFullShare = 0.9;
constexpr double kRaiseShare = 0.7;
// A finer step that was left so soon was too fine. One that was kept for so long fits.
constexpr int64_t kTrial_ns = 2'000'000'000;
constexpr int64_t kRaiseWaitMax_ns = 8'000'000'000;
// A line is far too slow where it takes less than every other atlas. Another encoding, in this many
// coarser steps at least, would then give it all of them.
constexpr double kFarShare = 0.5;
constexpr size_t kFarSteps = 2;
static_assert(kStepBytes * kStepBytes < kFarShare);

}  // namespace

size_t QualityRung::stepCount() const {
  return (range_.coarsest_qp - range_.finest_qp + kStepQp - 1) / kStepQp + 1;
}

uint32_t QualityRung::qpOf(size_t step) const {
  return std::min(range_.finest_qp + kStepQp * uint32_t(step), range_.coarsest_qp);
}

void QualityRung::noteBegun(int64_t now_ns) {
  begun_ns_.push_back(now_ns);
  while (begun_ns_.size() > kBegunMax || begun_ns_.front() < now_ns - kRungWindow_ns) {
    begun_ns_.pop_front();
  }
}

void QualityRung::noteCoded(uint32_t qp, uint64_t bytes) {
  const double steps = (double(qp) - double(range_.finest_qp)) / kStepQp;
  const double finest_bytes = double(bytes) / std::pow(kStepBytes, steps);
  const bool is_first = finest_bytes_ == 0;
  finest_bytes_ = is_first ? finest_bytes : std::lerp(finest_bytes_, finest_bytes, kNewestWeight);
}

double QualityRung::bytesAt(uint32_t qp) const {
  const double steps = (double(qp) - double(range_.finest_qp)) / kStepQp;
  return finest_bytes_ * std::pow(kStepBytes, steps);
}

size_t QualityRung::atlasesPerSecond(int64_t now_ns) const {
  return size_t(std::ranges::count_if(
      begun_ns_, [&](int64_t begun_ns) { return begun_ns > now_ns - kRungWindow_ns; }));
}

double QualityRung::demand(uint32_t qp, int64_t now_ns) const {
  return double(atlasesPerSecond(now_ns)) * bytesAt(qp);
}

uint32_t QualityRung::finestAlone() const {
  if (range_.bits_per_second_max == 0) return range_.finest_qp;
  const double bytes_max = double(range_.bits_per_second_max) / 8;
  size_t step = 0;
  while (step + 1 < stepCount() && bytesAt(qpOf(step)) > bytes_max) ++step;
  return qpOf(step);
}

// A line that shows no limit takes at least what it has been given. It is worth a finer step where
// that is the next one.
LineFit QualityRung::fitOf(const LineSpeed& line, int64_t now_ns) const {
  const double needed = demand(qp(), now_ns);
  if (needed == 0) return LineFit::kNear;
  if (!line.bytes_per_second) {
    const bool had_nearly_all = double(line.recent_bytes) >= kStepBytes * needed;
    return had_nearly_all ? LineFit::kFits : LineFit::kUnknown;
  }
  if (needed <= kRaiseShare * *line.bytes_per_second) return LineFit::kFits;
  const bool is_far = *line.bytes_per_second < kFarShare * needed;
  return is_far && step_ + kFarSteps < stepCount() ? LineFit::kFar : LineFit::kNear;
}

size_t QualityRung::firstFitting(double limit, int64_t now_ns) const {
  size_t step = 0;
  while (step + 1 < stepCount() && demand(qpOf(step), now_ns) > limit) ++step;
  return step;
}

void QualityRung::adapt(std::optional<double> link_bytes_per_second, int64_t now_ns) {
  double limit = link_bytes_per_second.value_or(HUGE_VAL);
  // Readers may be given all of what they want at most.
  if (range_.bits_per_second_max != 0) {
    limit = std::min(limit, double(range_.bits_per_second_max) / 8 / kFullShare);
  }
  const bool has_changed = changed_ns_ != INT64_MIN;
  const int64_t since_ns = has_changed ? now_ns - changed_ns_ : INT64_MAX;
  const bool is_on_trial = was_raised_ && since_ns < kTrial_ns;
  if (was_raised_ && !is_on_trial) raise_wait_ns_ = kRaiseWait_ns;
  const size_t fitting = firstFitting(kFullShare * limit, now_ns);
  if (fitting > step_) {
    if (is_on_trial) raise_wait_ns_ = std::min(2 * raise_wait_ns_, kRaiseWaitMax_ns);
    step_ = fitting;
    was_raised_ = false;
    changed_ns_ = now_ns;
    return;
  }
  if (step_ == 0 || since_ns < raise_wait_ns_) return;
  if (demand(qpOf(step_ - 1), now_ns) > kRaiseShare * limit) return;
  --step_;
  was_raised_ = true;
  changed_ns_ = now_ns;
}

}  // namespace viewloom
