// SPDX-License-Identifier: Apache-2.0
#include "web/atlas_inbox.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "unit/publish/chained_atlases.h"

namespace viewloom::atlas_inbox_test {
namespace {

AtlasPtr atlasOf(uint64_t sequence) {
  auto atlas = std::make_shared<EncodedAtlas>();
  atlas->sequence = sequence;
  return atlas;
}

TEST(AtlasInbox, keepsTheNewestAndCountsTheRest) {
  ManualClock clock;
  Metrics metrics;
  int change_count = 0;
  AtlasInbox inbox(clock, metrics.replaced[HandOver::kWeb], [&] { ++change_count; });
  EXPECT_FALSE(inbox.take());
  inbox.offer(atlasOf(1));
  inbox.offer(atlasOf(2));
  clock.advance(10);
  const int64_t arrived_ns = clock.nowNs();
  inbox.offer(atlasOf(3));
  const auto arrival = inbox.take();
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->atlas->sequence, 3u);
  EXPECT_EQ(arrival->arrived_ns, arrived_ns);
  EXPECT_FALSE(inbox.take());
  EXPECT_EQ(inbox.replacedCount(), 2u);
  EXPECT_EQ(metrics.replaced[HandOver::kWeb].value(), 2);
  EXPECT_EQ(change_count, 3);
}

TEST(AtlasInbox, keepsChainedAtlasesInOrder) {
  ManualClock clock;
  Metrics metrics;
  AtlasInbox inbox(clock, metrics.replaced[HandOver::kWeb], [] {});
  inbox.offer(test::chainedAtlas(1, 0));
  inbox.offer(test::chainedAtlas(2, 1));
  inbox.offer(test::chainedAtlas(4, 3));
  EXPECT_TRUE(inbox.isStuck());
  EXPECT_EQ(inbox.fallOutCount(), 1u);
  EXPECT_EQ(inbox.replacedCount(), 1u);
  EXPECT_EQ(inbox.take()->atlas->sequence, 1u);
  EXPECT_EQ(inbox.take()->atlas->sequence, 2u);
  EXPECT_FALSE(inbox.take());
}

TEST(AtlasInbox, tellsHowItEnded) {
  ManualClock clock;
  Metrics metrics;
  AtlasInbox inbox(clock, metrics.replaced[HandOver::kWeb], [] {});
  EXPECT_FALSE(inbox.ended());
  inbox.end(absl::UnavailableError("gone"));
  ASSERT_TRUE(inbox.ended());
  EXPECT_EQ(inbox.ended()->code(), absl::StatusCode::kUnavailable);
}

TEST(AtlasInbox, losesNoAtlasBetweenThreads) {
  constexpr uint64_t kAtlasCount = 20'000;
  const SteadyClock clock;
  Metrics metrics;
  std::atomic<uint64_t> wakes = 0;
  AtlasInbox inbox(clock, metrics.replaced[HandOver::kWeb], [&] {
    ++wakes;
    wakes.notify_one();
  });
  std::thread publisher([&] {
    for (uint64_t i = 1; i <= kAtlasCount; ++i) inbox.offer(atlasOf(i));
  });
  uint64_t taken_count = 0;
  uint64_t newest = 0;
  while (newest < kAtlasCount) {
    const uint64_t seen = wakes;
    if (const auto arrival = inbox.take()) {
      EXPECT_GT(arrival->atlas->sequence, newest);
      newest = arrival->atlas->sequence;
      ++taken_count;
    } else {
      wakes.wait(seen);
    }
  }
  publisher.join();
  EXPECT_EQ(taken_count + inbox.replacedCount(), kAtlasCount);
}

}  // namespace
}  // namespace viewloom::atlas_inbox_test
