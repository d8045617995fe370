// SPDX-License-Identifier: Apache-2.0
#include "lib/send_pace.h"

#include <gtest/gtest.h>

namespace viewloom::send_pace_test {
namespace {

constexpr int64_t kMs_ns = 1'000'000;

TEST(SendPace, holdsNothingBackWithoutARate) {
  SendPace pace;
  pace.note(1000 * kMs_ns);
  EXPECT_LE(pace.dueNs(), 1000 * kMs_ns);
}

TEST(SendPace, keepsToARate) {
  SendPace pace;
  pace.setRate(10);
  int count = 0;
  for (int64_t now_ns = 1000 * kMs_ns; now_ns < 11'000 * kMs_ns; now_ns += 7 * kMs_ns) {
    if (now_ns < pace.dueNs()) continue;
    pace.note(now_ns);
    ++count;
  }
  EXPECT_NEAR(count, 100, 2);
}

TEST(SendPace, makesNothingUpForALongPause) {
  SendPace pace;
  pace.setRate(10);
  pace.note(1000 * kMs_ns);
  pace.note(60'000 * kMs_ns);
  EXPECT_EQ(pace.dueNs(), 60'100 * kMs_ns);
}

TEST(SendPace, letsFramesGoWhenTheRateIsGone) {
  SendPace pace;
  pace.setRate(1);
  pace.note(1000 * kMs_ns);
  EXPECT_GT(pace.dueNs(), 1500 * kMs_ns);
  pace.setRate(0);
  EXPECT_LE(pace.dueNs(), 1000 * kMs_ns);
}

}  // namespace
}  // namespace viewloom::send_pace_test
