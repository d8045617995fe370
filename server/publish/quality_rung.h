// SPDX-License-Identifier: Apache-2.0
// Quantisation of a display's video, chosen so that its readers' lines can take it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "publish/line_fit.h"

namespace viewloom {

// Quantisations that may be chosen, and what readers want at most.
struct QualityRange {
  uint32_t finest_qp = 24;
  uint32_t coarsest_qp = 40;         // at least finest_qp
  uint64_t bits_per_second_max = 0;  // 0 = as many as the lines take
};

// Steps of four from the finest to the coarsest. It goes to a coarser step at once, as far as is
// needed. It goes to a finer one a step at a time, after a while in which the line had room; a step
// that was too fine makes the next attempt later. Times are monotonic. Thread-safety: none.
class QualityRung {
 public:
  explicit QualityRung(const QualityRange& range) : range_(range) {}

  uint32_t qp() const { return qpOf(step_); }
  // An atlas begins; all together they are the display's rate.
  void noteBegun(int64_t now_ns);
  // An atlas was coded with this quantisation.
  void noteCoded(uint32_t qp, uint64_t bytes);
  // Chooses anew for a line of so many bytes a second; none = no limit shows.
  void adapt(std::optional<double> link_bytes_per_second, int64_t now_ns);

  // Finest quantisation at which one atlas fits into the bits that readers want in a second, or the
  // coarsest. For frames that stand, so that the next one does not have to wait.
  uint32_t finestAlone() const;

  // Bytes a second at a quantisation; 0 before the first atlas.
  double demand(uint32_t qp, int64_t now_ns) const;
  // Atlases that began in the last second.
  size_t atlasesPerSecond(int64_t now_ns) const;
  // How it suits the line of a reader, as it is now.
  LineFit fitOf(const LineSpeed& line, int64_t now_ns) const;

 private:
  uint32_t qpOf(size_t step) const;
  size_t stepCount() const;
  // Bytes of an atlas; 0 before the first.
  double bytesAt(uint32_t qp) const;
  size_t firstFitting(double limit, int64_t now_ns) const;

  const QualityRange range_;
  size_t step_ = 0;
  double finest_bytes_ = 0;         // of an atlas at the finest step; smoothed
  std::deque<int64_t> begun_ns_;    // of the last second, bounded
  int64_t changed_ns_ = INT64_MIN;  // when the step last changed; INT64_MIN = never
  bool was_raised_ = false;         // that change was to a finer one
  int64_t raise_wait_ns_ = kRaiseWait_ns;

  static constexpr int64_t kRaiseWait_ns = 1'000'000'000;
};

}  // namespace viewloom
