// SPDX-License-Identifier: Apache-2.0
#include "web/message_pace.h"

#include <gtest/gtest.h>

namespace viewloom::message_pace_test {
namespace {

constexpr int64_t kSecond_ns = 1'000'000'000;

// Messages that are read within a time, if they come as fast as they are read.
int readWithin(int64_t time_ns, size_t bytes) {
  MessagePace pace({.messages_per_s = 100, .bytes_per_s = 10'000, .burst_ns = kSecond_ns});
  int count = 0;
  for (int64_t now_ns = 0; now_ns < time_ns; ++count) now_ns += pace.delayNs(now_ns, bytes);
  return count;
}

TEST(MessagePace, holdsNobodyUpWhoKeepsTheRate) {
  MessagePace pace({.messages_per_s = 100, .bytes_per_s = 10'000, .burst_ns = kSecond_ns});
  for (int64_t i = 0; i < 1000; ++i) EXPECT_EQ(pace.delayNs(i * kSecond_ns / 50, 50), 0) << i;
}

TEST(MessagePace, readsAFloodAtTheRateAfterABurst) {
  EXPECT_NEAR(readWithin(10 * kSecond_ns, 0), 1100, 2);
}

TEST(MessagePace, countsTheBytesOfLargeMessages) {
  // 1 s + 0.01 s each.
  EXPECT_NEAR(readWithin(10 * kSecond_ns, 10'000), 11, 1);
}

TEST(MessagePace, forgivesAfterAPause) {
  MessagePace pace({.messages_per_s = 100, .bytes_per_s = 10'000, .burst_ns = kSecond_ns});
  for (int i = 0; i < 100; ++i) EXPECT_EQ(pace.delayNs(0, 0), 0);
  EXPECT_GT(pace.delayNs(0, 0), 0);
  EXPECT_EQ(pace.delayNs(5 * kSecond_ns, 0), 0);
}

}  // namespace
}  // namespace viewloom::message_pace_test
