// SPDX-License-Identifier: Apache-2.0
// Brings what a tracer answered before the oracle's judge, view by view.
#pragma once

#include <cstdint>
#include <string>

#include "gpu/walk_under_test.h"
#include "oracle/judge.h"

namespace viewloom {

struct JudgedViews {
  oracle::Verdict verdict;
  uint64_t visits = 0;          // of all rays together
  uint32_t visits_largest = 0;  // of one ray
  double visits_bound_share =
      0;  // the largest share of 4 (width + height) layers that a ray visited

  void add(const JudgedViews& other);
  std::string summary() const;
};

oracle::TestedAnswer testedAnswer(const abi::RayRecord& record);

// Judges every ray of the views as they were traced, or of every stride-th column and row.
JudgedViews judgeTraced(const std::vector<TracedView>& traced, const oracle::OracleSource& source,
                        const std::vector<oracle::OutputView>& views, double tolerance_px,
                        const std::string& where, int stride = 1);

// Fails the test unless a view from the source's own pose sees each px of its nearest layer.
void expectSeesItself(const TracedView& traced, const oracle::OracleSource& source,
                      const std::string& where);

// Traces the views and judges every ray of them, or of every stride-th column and row. `where`
// names the scene in messages.
JudgedViews judgeViews(WalkUnderTest& walk, const StructureSlot& slot,
                       const oracle::OracleSource& source,
                       const std::vector<oracle::OutputView>& views, double tolerance_px,
                       const std::string& where, int stride = 1);

}  // namespace viewloom
