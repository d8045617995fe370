// SPDX-License-Identifier: Apache-2.0
#include "schedule/build_gate.h"

#include <gtest/gtest.h>

namespace viewloom::build_gate_test {
namespace {

constexpr int64_t kMs_ns = 1'000'000;
constexpr StreamDemand kWatched{.is_watched = true};
constexpr StreamDemand kTakesAll{.is_watched = true, .takes_all = true};
constexpr StreamDemand kUnwatched{};

// Frames that are built of 60 a second, which replace each other.
int builtOf(BuildGate& gate, const StreamDemand& demand, int64_t begin_ns, int64_t end_ns) {
  int count = 0;
  for (int64_t now_ns = begin_ns; now_ns < end_ns; now_ns += 1'000 * kMs_ns / 60) {
    if (gate.waitUntilNs(demand, now_ns)) continue;
    gate.noteBuilt(demand, now_ns);
    ++count;
  }
  return count;
}

TEST(BuildGate, letsAllFramesThroughThatAreShownAsTheyCome) {
  BuildGate gate;
  EXPECT_EQ(builtOf(gate, kTakesAll, 0, 1000 * kMs_ns), 61);
}

TEST(BuildGate, letsAFrameASecondThroughThatNobodyWatches) {
  BuildGate gate;
  EXPECT_EQ(builtOf(gate, kUnwatched, 0, 10'000 * kMs_ns), kUnwatchedBurst + 9);
  EXPECT_EQ(builtOf(gate, kTakesAll, 10'000 * kMs_ns, 10'500 * kMs_ns), 31) << "somebody came";
  EXPECT_EQ(builtOf(gate, kUnwatched, 100'000 * kMs_ns, 100'500 * kMs_ns), kUnwatchedBurst);
}

TEST(BuildGate, leavesFramesToThePicturesThatAskForThem) {
  BuildGate gate;
  EXPECT_FALSE(gate.waitUntilNs(kWatched, 0)) << "there is none before";
  gate.noteBuilt(kWatched, 100 * kMs_ns);
  EXPECT_EQ(gate.waitUntilNs(kWatched, 200 * kMs_ns), 100 * kMs_ns + kHeldFrame_ns);
  EXPECT_FALSE(gate.waitUntilNs(kWatched, 100 * kMs_ns + kHeldFrame_ns));
}

}  // namespace
}  // namespace viewloom::build_gate_test
