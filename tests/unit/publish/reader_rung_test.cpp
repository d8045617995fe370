// SPDX-License-Identifier: Apache-2.0
#include "publish/reader_rung.h"

#include <gtest/gtest.h>

namespace viewloom::test::reader_rung_test {
namespace {

constexpr int64_t kMs = 1'000'000;

class ReaderRungTest : public testing::Test {
 protected:
  // Whether the reader moved within so long before such a line. After that, time stands.
  bool movesWithin(int64_t duration_ms, LineFit first) {
    for (const int64_t end_ns = now_ns_ + duration_ms * kMs; now_ns_ < end_ns;) {
      now_ns_ += 250 * kMs;
      if (!rung_.wantsOther(first, now_ns_)) continue;
      rung_.noteMoved(now_ns_);
      return true;
    }
    return false;
  }

  ReaderRung rung_;
  int64_t now_ns_ = 0;
};

TEST_F(ReaderRungTest, leavesTheFirstOnlyForALineThatStaysFarTooSlow) {
  EXPECT_EQ(rung_.rung(), VideoRung::kFirst);
  EXPECT_FALSE(movesWithin(2750, LineFit::kFar));
  EXPECT_FALSE(movesWithin(250, LineFit::kNear)) << "a break";
  EXPECT_FALSE(movesWithin(2750, LineFit::kFar));
  EXPECT_TRUE(movesWithin(500, LineFit::kFar));
  EXPECT_EQ(rung_.rung(), VideoRung::kSecond);
  EXPECT_FALSE(movesWithin(60'000, LineFit::kFar)) << "there is no third";
}

TEST_F(ReaderRungTest, staysOnTheFirstWhateverElseTheLineIs) {
  for (const LineFit fit : {LineFit::kNear, LineFit::kUnknown, LineFit::kFits}) {
    EXPECT_FALSE(movesWithin(120'000, fit));
  }
}

TEST_F(ReaderRungTest, returnsOnceTheFirstFits) {
  EXPECT_TRUE(movesWithin(4000, LineFit::kFar));
  EXPECT_FALSE(movesWithin(120'000, LineFit::kNear));
  EXPECT_FALSE(movesWithin(2750, LineFit::kFits));
  EXPECT_TRUE(movesWithin(500, LineFit::kFits));
  EXPECT_EQ(rung_.rung(), VideoRung::kFirst);
}

TEST_F(ReaderRungTest, triesALineThatShowsNoLimitAfterALongerTime) {
  EXPECT_TRUE(movesWithin(4000, LineFit::kFar));
  EXPECT_FALSE(movesWithin(23'000, LineFit::kUnknown));
  EXPECT_TRUE(movesWithin(2000, LineFit::kUnknown));
}

TEST_F(ReaderRungTest, waitsLongerAfterAReturnInVain) {
  int return_count = 0;
  EXPECT_TRUE(movesWithin(4000, LineFit::kFar));
  // Each return is in vain: the line fits only as long as it is not used.
  for (const int64_t wait_ms : {3000, 6000, 12'000, 24'000, 24'000}) {
    EXPECT_FALSE(movesWithin(wait_ms - 250, LineFit::kFits)) << wait_ms;
    return_count += movesWithin(500, LineFit::kFits);
    EXPECT_TRUE(movesWithin(4000, LineFit::kFar));
  }
  EXPECT_EQ(return_count, 5);
  EXPECT_TRUE(movesWithin(25'000, LineFit::kFits));
  EXPECT_FALSE(movesWithin(10'000, LineFit::kFits)) << "this one holds";
  EXPECT_TRUE(movesWithin(4000, LineFit::kFar));
  EXPECT_TRUE(movesWithin(3500, LineFit::kFits)) << "the wait is the usual one again";
}

TEST_F(ReaderRungTest, asksAgainAfterAsLongWhereItCouldNotMove) {
  int ask_count = 0;
  for (; now_ns_ < 10'000 * kMs; now_ns_ += 250 * kMs) {
    ask_count += rung_.wantsOther(LineFit::kFar, now_ns_);
  }
  EXPECT_EQ(ask_count, 3);
  EXPECT_EQ(rung_.rung(), VideoRung::kFirst);
}

}  // namespace
}  // namespace viewloom::test::reader_rung_test
