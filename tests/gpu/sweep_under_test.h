// SPDX-License-Identifier: Apache-2.0
// Columns and sweep as the server runs them, on scenes and views of the oracle.
#pragma once

#include <vector>

#include "gpu/walk_under_test.h"
#include "sweep/sweep_source.h"
#include "sweep/view_sweeper.h"

namespace viewloom {

// Thread-safety: none.
class SweepUnderTest {
 public:
  void prepare(FramePtr frame) { source_.prepare(std::move(frame), workers_); }
  const SweepSource& source() const { return source_; }
  void plantFault(SweepFault fault) { planted_fault_ = fault; }
  // Views of one size, of which all can be swept.
  std::vector<TracedView> trace(const std::vector<oracle::OutputView>& views, double tolerance_px);

 private:
  WorkerPool workers_{2};
  SweepSource source_;
  SweepFault planted_fault_ = SweepFault::kNone;
  ViewSweeper sweeper_;
};

}  // namespace viewloom
