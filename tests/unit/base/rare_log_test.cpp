// SPDX-License-Identifier: Apache-2.0
#include "base/rare_log.h"

#include <gtest/gtest.h>

namespace viewloom::rare_log_test {
namespace {

constexpr int64_t kPause_ns = 1'000'000'000;

TEST(RareLog, letsOneLineThroughInEachPause) {
  RareLog rare{std::chrono::nanoseconds(kPause_ns)};
  EXPECT_EQ(rare.take("first", 5), "first");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(rare.take("more", 4 + kPause_ns), std::nullopt);
  EXPECT_EQ(rare.take("next", 5 + kPause_ns), "next (3 such lines before it were left out)");
  EXPECT_EQ(rare.take("last", 5 + 2 * kPause_ns), "last");
}

}  // namespace
}  // namespace viewloom::rare_log_test
