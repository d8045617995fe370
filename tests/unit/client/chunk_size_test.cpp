// SPDX-License-Identifier: Apache-2.0
#include "lib/frame_messages.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace viewloom::chunk_size_test {
namespace {

constexpr int64_t kFast_ns = 50'000'000, kMiddling_ns = 200'000'000, kSlow_ns = 500'000'000;

TEST(ChunkSize, growsToTheLargestOnAFastLine) {
  ChunkSize size;
  EXPECT_EQ(size.bytes(), ChunkSize::kMin_bytes);
  size.note(kFast_ns);
  EXPECT_EQ(size.bytes(), 2 * ChunkSize::kMin_bytes);
  for (int i = 0; i < 10; ++i) size.note(kFast_ns);
  EXPECT_EQ(size.bytes(), ChunkSize::kMax_bytes);
}

TEST(ChunkSize, shrinksToTheSmallestOnASlowLine) {
  ChunkSize size;
  for (int i = 0; i < 10; ++i) size.note(kFast_ns);
  size.note(kSlow_ns);
  EXPECT_EQ(size.bytes(), ChunkSize::kMax_bytes / 2);
  for (int i = 0; i < 10; ++i) size.note(kSlow_ns);
  EXPECT_EQ(size.bytes(), ChunkSize::kMin_bytes);
}

TEST(ChunkSize, staysWhereALineIsNeither) {
  ChunkSize size;
  size.note(kFast_ns);
  size.note(kMiddling_ns);
  EXPECT_EQ(size.bytes(), 2 * ChunkSize::kMin_bytes);
}

// A chunk never keeps the line for longer than servers wait for a heartbeat.
TEST(ChunkSize, settlesBelowASecondOnEveryLine) {
  for (const double bytes_per_s : {65e3, 125e3, 1e6, 10e6, 1e9}) {
    ChunkSize size;
    double longest_s = 0;
    for (int i = 0; i < 100; ++i) {
      const double duration_s = double(size.bytes()) / bytes_per_s;
      if (i > 20) longest_s = std::max(longest_s, duration_s);
      size.note(int64_t(1e9 * duration_s));
    }
    EXPECT_LT(longest_s, 1.1) << bytes_per_s;
  }
}

}  // namespace
}  // namespace viewloom::chunk_size_test
