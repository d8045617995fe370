// SPDX-License-Identifier: Apache-2.0
#include "base/latest_mailbox.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>

namespace viewloom::latest_mailbox_test {
namespace {

TEST(LatestMailbox, handsOutTheNewestItemOnce) {
  LatestMailbox<int> mailbox;
  EXPECT_TRUE(mailbox.empty());
  mailbox.push(1);
  mailbox.push(2);
  EXPECT_FALSE(mailbox.empty());
  EXPECT_EQ(mailbox.take(), 2);
  EXPECT_EQ(mailbox.take(), std::nullopt);
  EXPECT_TRUE(mailbox.empty());
}

TEST(LatestMailbox, countsTheItemItReplaces) {
  LatestMailbox<int> mailbox;
  EXPECT_EQ(mailbox.push(1), std::nullopt);
  EXPECT_EQ(mailbox.push(2), 1);
  mailbox.take();
  EXPECT_EQ(mailbox.push(3), std::nullopt);
  EXPECT_EQ(mailbox.replacedCount(), 1U);
}

TEST(LatestMailbox, losesAndRepeatsNothingAcrossThreads) {
  constexpr int kItems = 20000;
  LatestMailbox<std::unique_ptr<int>> mailbox;
  std::atomic<bool> done = false;
  uint64_t replaced_count = 0;
  std::jthread producer([&] {
    for (int i = 1; i <= kItems; ++i) {
      replaced_count += mailbox.push(std::make_unique<int>(i)).has_value();
    }
    done = true;
  });
  uint64_t taken_count = 0;
  int newest = 0;
  for (bool last_round = false; !last_round;) {
    last_round = done;
    while (auto item = mailbox.take()) {
      EXPECT_GT(**item, newest);
      newest = **item;
      ++taken_count;
    }
  }
  producer.join();
  EXPECT_EQ(newest, kItems);
  EXPECT_EQ(taken_count + replaced_count, uint64_t{kItems});
  EXPECT_EQ(mailbox.replacedCount(), replaced_count);
}

}  // namespace
}  // namespace viewloom::latest_mailbox_test
