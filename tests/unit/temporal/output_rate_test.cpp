// SPDX-License-Identifier: Apache-2.0
#include "temporal/output_rate.h"

#include <gtest/gtest.h>

namespace viewloom::output_rate_test {
namespace {

constexpr int64_t kStart_ns = 12'345;
constexpr int64_t kSecond_ns = 1'000'000'000;

TEST(OutputClock, ticksAtOnceAndThenAtItsRateWithoutDrift) {
  OutputClock clock(59.94, kStart_ns);
  for (int64_t n = 0; n < 100'000; n += 1) {
    const int64_t due_ns = clock.dueNs();
    EXPECT_NEAR(double(due_ns - kStart_ns), double(n) * 1e9 / 59.94, 0.51) << n;
    EXPECT_FALSE(clock.take(due_ns - 1).has_value());
    const auto tick = clock.take(due_ns);
    ASSERT_TRUE(tick.has_value());
    EXPECT_EQ(tick->due_ns, due_ns);
    EXPECT_EQ(tick->missed_count, 0u);
  }
}

TEST(OutputClock, givesTheNewestTickAndCountsThoseThatNobodySaw) {
  OutputClock clock(10, kStart_ns);
  clock.take(kStart_ns);
  const auto late = clock.take(kStart_ns + kSecond_ns / 2 + 7);
  ASSERT_TRUE(late.has_value());
  EXPECT_EQ(late->due_ns, kStart_ns + kSecond_ns / 2);
  EXPECT_EQ(late->missed_count, 4u);
  EXPECT_EQ(clock.dueNs(), kStart_ns + 6 * kSecond_ns / 10) << "the one after keeps its time";
}

TEST(OutputClock, staysRightAfterAYear) {
  constexpr int64_t kYear_ns = 365 * 86400 * kSecond_ns;
  OutputClock clock(240, kStart_ns);
  const auto tick = clock.take(kStart_ns + kYear_ns);
  ASSERT_TRUE(tick.has_value());
  EXPECT_EQ(tick->due_ns, kStart_ns + kYear_ns);
  EXPECT_EQ(tick->missed_count, uint64_t{240} * 365 * 86400);
}

}  // namespace
}  // namespace viewloom::output_rate_test
