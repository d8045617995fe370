// SPDX-License-Identifier: Apache-2.0
#include "rpc/held_back.h"

#include <gtest/gtest.h>

namespace viewloom::held_back_test {
namespace {

constexpr int64_t kMs_ns = 1'000'000;

TEST(HeldBack, holdsWhileAFrameWaits) {
  HeldBack held_back;
  EXPECT_FALSE(held_back.holds(0));
  held_back.noteOffered(1, 0);
  EXPECT_TRUE(held_back.holds(500 * kMs_ns));
  EXPECT_EQ(held_back.noteTaken(1, 600 * kMs_ns), 600 * kMs_ns);
  EXPECT_FALSE(held_back.holds(600 * kMs_ns));
}

// The kernels of a picture compile for seconds.
TEST(HeldBack, letsNewerFramesReplaceOneThatWaitsForLong) {
  HeldBack held_back;
  held_back.noteOffered(1, 0);
  int64_t now_ns = HeldBack::kMost_ns;
  for (uint64_t number = 2; number <= 50; ++number) {
    EXPECT_FALSE(held_back.holds(now_ns));
    held_back.noteOffered(number, now_ns);
    EXPECT_EQ(held_back.noteTaken(number - 1, now_ns), std::nullopt) << "it is replaced";
    now_ns += 100 * kMs_ns;
  }
  EXPECT_EQ(held_back.noteTaken(50, now_ns), now_ns) << "since the first has come";
  held_back.noteOffered(51, now_ns);
  EXPECT_TRUE(held_back.holds(now_ns));
}

}  // namespace
}  // namespace viewloom::held_back_test
