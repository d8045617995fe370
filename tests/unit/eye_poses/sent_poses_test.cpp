// SPDX-License-Identifier: Apache-2.0
#include "eye_poses/sent_poses.h"

#include <gtest/gtest.h>

#include <limits>

namespace viewloom::sent_poses_test {
namespace {

constexpr int64_t kMs = 1'000'000;

TEST(SentPoses, tellsHowLongMotionTookToItsPicture) {
  SentPoses sent;
  sent.note(1, 100 * kMs);
  sent.note(2, 111 * kMs);
  EXPECT_DOUBLE_EQ(*sent.latencySeconds(1, 120 * kMs), 0.020);
  EXPECT_DOUBLE_EQ(*sent.latencySeconds(2, 120 * kMs), 0.009);
  EXPECT_EQ(sent.latencySeconds(3, 120 * kMs), std::nullopt) << "was not sent";
}

TEST(SentPoses, forgetsWhatNobodyShowsAnyMore) {
  SentPoses sent;
  for (uint64_t sequence = 1; sequence <= 65; ++sequence) sent.note(sequence, kMs);
  EXPECT_EQ(sent.latencySeconds(1, 2 * kMs), std::nullopt);
  EXPECT_TRUE(sent.latencySeconds(2, 2 * kMs).has_value());
  EXPECT_TRUE(sent.latencySeconds(65, 2 * kMs).has_value());
  sent.clear();
  EXPECT_EQ(sent.latencySeconds(65, 2 * kMs), std::nullopt) << "of another display";
}

TEST(SentPoses, takesNoDifferenceOfTwoClocksForALatency) {
  constexpr int64_t kLeast = std::numeric_limits<int64_t>::min();
  constexpr int64_t kMost = std::numeric_limits<int64_t>::max();
  SentPoses sent;
  sent.note(1, 0);
  sent.note(2, kMost);
  sent.note(3, kLeast);
  sent.note(4, 100 * kMs);
  EXPECT_EQ(sent.latencySeconds(0, 1), std::nullopt);
  EXPECT_EQ(sent.latencySeconds(1, 1), std::nullopt) << "no poses had come";
  EXPECT_EQ(sent.latencySeconds(2, kLeast), std::nullopt);
  EXPECT_EQ(sent.latencySeconds(3, kMost), std::nullopt);
  EXPECT_EQ(sent.latencySeconds(4, 99 * kMs), std::nullopt);
  EXPECT_EQ(sent.latencySeconds(4, 60'100 * kMs), std::nullopt);
  EXPECT_TRUE(sent.latencySeconds(4, 60'099 * kMs).has_value());
}

}  // namespace
}  // namespace viewloom::sent_poses_test
