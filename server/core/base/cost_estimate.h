// SPDX-License-Identifier: Apache-2.0
// How long a unit of work of one kind takes, learnt by measuring.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace viewloom {

// Longest piece that work is cut into, as predicted. Between two pieces others get their turn.
inline constexpr int64_t kPiece_ns = 10'000'000;

// An exponentially weighted mean of measured times. It rises faster than it falls: a piece that
// takes too long keeps others waiting, one that is too short costs little.
// Thread-safety: all methods may be called from any thread. Of two measurements at one moment, one
// may be lost.
class CostEstimate {
 public:
  // A unit is taken to cost that much until something was measured; > 0.
  explicit CostEstimate(double start_ns_per_unit) : ns_per_unit_(start_ns_per_unit) {}
  // Begins with what the other one has learnt.
  CostEstimate(const CostEstimate& other) : ns_per_unit_(other.nsPerUnit()) {}
  CostEstimate& operator=(const CostEstimate& other) {
    ns_per_unit_ = other.nsPerUnit();
    return *this;
  }

  double nsPerUnit() const { return ns_per_unit_; }
  int64_t predictNs(uint64_t units) const { return int64_t(nsPerUnit() * double(units)); }
  // Units that a time suffices for, at least 1.
  uint64_t unitsFor(int64_t time_ns) const {
    const double units = double(time_ns) / nsPerUnit();
    return uint64_t(std::clamp(units, 1.0, kUnitsMax));
  }

  // So many units took so long.
  void note(uint64_t units, int64_t measured_ns) {
    if (units == 0 || measured_ns <= 0) return;
    const double before = nsPerUnit();
    const double measured =
        std::clamp(double(measured_ns) / double(units), before / kStepMax, before * kStepMax);
    const double weight = measured > before ? kRise : kFall;
    ns_per_unit_ = before + weight * (measured - before);
  }

 private:
  static constexpr double kRise = 0.5;
  static constexpr double kFall = 0.25;
  // A thread may have been off its core for long: one measurement changes no more than this.
  static constexpr double kStepMax = 16;
  static constexpr double kUnitsMax = 1e15;

  std::atomic<double> ns_per_unit_;
};

}  // namespace viewloom
