// SPDX-License-Identifier: Apache-2.0
#include "mp4/movie_clock.h"

#include <gtest/gtest.h>

#include <limits>

namespace viewloom::test::movie_clock_test {
namespace {

constexpr int64_t kMs = 1'000'000;

TEST(MovieClock, keepsTheStepsOfTheFrames) {
  MovieClock clock;
  EXPECT_EQ(clock.next(7'000 * kMs, 100 * kMs), 0);
  EXPECT_EQ(clock.next(7'033 * kMs, 210 * kMs), 33 * kMs) << "it came late";
  EXPECT_EQ(clock.next(7'066 * kMs, 215 * kMs), 66 * kMs);
  EXPECT_EQ(clock.end(600 * kMs), 500 * kMs);
}

TEST(MovieClock, takesTheTimeOfArrivalWhereFramesJump) {
  MovieClock clock;
  EXPECT_EQ(clock.next(9'000'000 * kMs, 0), 0);
  EXPECT_EQ(clock.next(50 * kMs, 1000 * kMs), 1000 * kMs) << "another publisher";
  EXPECT_EQ(clock.next(90 * kMs, 1200 * kMs), 1040 * kMs);
  EXPECT_EQ(clock.next(90 * kMs, 1300 * kMs), 1300 * kMs) << "the same frame once more";
  EXPECT_EQ(clock.next(std::numeric_limits<int64_t>::min(), 1400 * kMs), 1400 * kMs);
  EXPECT_EQ(clock.next(std::numeric_limits<int64_t>::max() / 2, 1500 * kMs), 1500 * kMs);
}

TEST(MovieClock, neverGoesBack) {
  MovieClock clock;
  EXPECT_EQ(clock.next(1000 * kMs, 0), 0);
  EXPECT_EQ(clock.next(1100 * kMs, 0), 100 * kMs);
  EXPECT_EQ(clock.next(1050 * kMs, 0), 101 * kMs);
  EXPECT_EQ(clock.end(0), 102 * kMs);
}

TEST(MovieClock, countsTicksWithoutDrift) {
  EXPECT_EQ(movieTicks(0), 0U);
  EXPECT_EQ(movieTicks(1'000'000'000), 90'000U);
  EXPECT_EQ(movieTicks(int64_t{86'400} * 365 * 1'000'000'000), 86'400ULL * 365 * 90'000);
}

}  // namespace
}  // namespace viewloom::test::movie_clock_test
