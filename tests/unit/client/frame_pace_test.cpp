// SPDX-License-Identifier: Apache-2.0
#include "cli/frame_feed.h"

#include <gtest/gtest.h>

namespace viewloom::cli::frame_pace_test {
namespace {

TEST(FramePace, goesByTheRateAndLeavesLateFramesOut) {
  ManualClock clock;
  FramePace pace(clock, 10);
  EXPECT_DOUBLE_EQ(pace.nextDue_s({}), 0.1);
  EXPECT_EQ(pace.left_ns(0.1), 100'000'000);
  clock.advance(100'000'000);
  EXPECT_LE(pace.left_ns(0.1), 0);
  EXPECT_DOUBLE_EQ(pace.nextDue_s({}), 0.2);
  clock.advance(450'000'000);
  EXPECT_LT(pace.left_ns(0.2), 0);
  EXPECT_DOUBLE_EQ(pace.nextDue_s({}), 0.5) << "0.3 and 0.4 are past";
}

TEST(FramePace, goesByTheFramesOwnTimes) {
  ManualClock clock;
  FramePace pace(clock, 10);
  EXPECT_DOUBLE_EQ(pace.nextDue_s(0.025), 0.025);
  clock.advance(30'000'000);
  EXPECT_EQ(pace.left_ns(0.025), -5'000'000);
  EXPECT_DOUBLE_EQ(pace.nextDue_s(0.027), 0.027) << "none is left out";
  EXPECT_GT(pace.left_ns(1e300), 0) << "whatever a file says";
}

}  // namespace
}  // namespace viewloom::cli::frame_pace_test
