// SPDX-License-Identifier: Apache-2.0
#include "cli/frame_feed.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace viewloom::cli {
namespace {

constexpr double kLeftMax_s = 1e9;  // thirty years: more does not fit ns everywhere

}  // namespace

int64_t captureTimeNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

FramePace::FramePace(const Clock& clock, double rate_hz)
    : clock_(clock), start_ns_(clock.nowNs()), rate_hz_(rate_hz) {}

double FramePace::elapsed_s() const {
  return static_cast<double>(clock_.nowNs() - start_ns_) * 1e-9;
}

double FramePace::nextDue_s(std::optional<double> own_s) {
  if (own_s) return *own_s;
  due_index_ = std::max(due_index_ + 1, std::floor(elapsed_s() * rate_hz_));
  return due_index_ / rate_hz_;
}

int64_t FramePace::left_ns(double due_s) const {
  return static_cast<int64_t>(std::min(due_s - elapsed_s(), kLeftMax_s) * 1e9);
}

}  // namespace viewloom::cli
