// SPDX-License-Identifier: Apache-2.0
// All that the suite asks of the random scene of one seed: its structure, and a view of every kind.
#pragma once

#include <cstdint>
#include <string>

#include "gpu/judge_views.h"
#include "gpu/structure_checks.h"
#include "gpu/sweep_under_test.h"

namespace viewloom {

struct JudgedSeed {
  std::string scene;  // what it shows, its size and its layers
  Complaints complaints;
  JudgedViews judged;

  bool agrees() const { return complaints.empty() && judged.verdict.differing == 0; }
  std::string text() const;
};

JudgedSeed judgeSeed(WalkUnderTest& walk, uint64_t seed);

// The same of the sweep: three views beside the source. No structure is built, none is checked.
JudgedSeed judgeSweptSeed(SweepUnderTest& sweep, uint64_t seed);

}  // namespace viewloom
