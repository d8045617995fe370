// SPDX-License-Identifier: Apache-2.0
#include "lib/latency.h"

#include <gtest/gtest.h>

namespace viewloom::frame_latency_test {
namespace {

constexpr int64_t kSecond_ns = 1'000'000'000;

TEST(FrameLatency, isTheTimeFromCaptureToHereOfAFrameThatCame) {
  FrameLatency latency;
  latency.note(1, 1 * kSecond_ns, 2 * kSecond_ns);
  latency.note(2, 3 * kSecond_ns, 3 * kSecond_ns + kSecond_ns / 4);
  EXPECT_EQ(latency.seconds(), 0.25);
}

TEST(FrameLatency, isUnknownOfAPictureThatStoodBefore) {
  FrameLatency latency;
  latency.note(7, 1 * kSecond_ns, 31 * kSecond_ns);
  EXPECT_EQ(latency.seconds(), std::nullopt) << "its age is no latency";
  latency.note(7, 1 * kSecond_ns, 40 * kSecond_ns);
  EXPECT_EQ(latency.seconds(), std::nullopt) << "it was traced again for eyes that moved";
  latency.note(8, 1 * kSecond_ns, 50 * kSecond_ns);
  EXPECT_EQ(latency.seconds(), std::nullopt) << "it was sent again";
}

TEST(FrameLatency, keepsThatOfTheLastFrameWhileItStands) {
  FrameLatency latency;
  latency.note(1, 1 * kSecond_ns, 2 * kSecond_ns);
  latency.note(2, 3 * kSecond_ns, 3 * kSecond_ns + kSecond_ns / 2);
  latency.note(2, 3 * kSecond_ns, 9 * kSecond_ns);
  EXPECT_EQ(latency.seconds(), 0.5);
  EXPECT_EQ(latency.standing_s(4 * kSecond_ns), std::nullopt);
  EXPECT_EQ(latency.standing_s(13 * kSecond_ns + kSecond_ns / 2), 10);
}

TEST(FrameLatency, isUnknownWhereClocksDiffer) {
  FrameLatency latency;
  latency.note(1, kSecond_ns, kSecond_ns);
  latency.note(2, 2 * kSecond_ns, 2 * kSecond_ns - 1);
  EXPECT_EQ(latency.seconds(), std::nullopt);
  latency.note(3, 3 * kSecond_ns, 63 * kSecond_ns);
  EXPECT_EQ(latency.seconds(), std::nullopt);
  latency.note(4, INT64_MIN, INT64_MAX);
  EXPECT_EQ(latency.seconds(), std::nullopt);
}

}  // namespace
}  // namespace viewloom::frame_latency_test
