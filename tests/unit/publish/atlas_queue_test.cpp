// SPDX-License-Identifier: Apache-2.0
#include "publish/atlas_queue.h"

#include <gtest/gtest.h>

#include "publish/fall_outs.h"
#include "unit/publish/chained_atlases.h"

namespace viewloom::test::atlas_queue_test {
namespace {

constexpr size_t kHalf = AtlasQueue::kWaitingBytesMax / 2;
constexpr int64_t kSecond = 1'000'000'000;

TEST(AtlasQueue, keepsTheNewestOfAtlasesThatNeedNoOther) {
  AtlasQueue queue;
  EXPECT_EQ(queue.offer(chainedAtlas(1, 0)), 0u);
  EXPECT_EQ(queue.offer(chainedAtlas(2, 0), 7), 1u);
  EXPECT_EQ(queue.front().sequence, 2u);
  const AtlasQueue::Waiting taken = queue.take();
  EXPECT_EQ(taken.atlas->sequence, 2u);
  EXPECT_EQ(taken.arrived_ns, 7);
  EXPECT_TRUE(queue.isEmpty());
  EXPECT_EQ(queue.offer(chainedAtlas(3, 0)), 0u);
  EXPECT_FALSE(queue.isStuck());
}

TEST(AtlasQueue, keepsChainedAtlasesInOrder) {
  AtlasQueue queue;
  for (uint64_t sequence = 5; sequence < 9; ++sequence) {
    EXPECT_EQ(queue.offer(chainedAtlas(sequence, sequence == 5 ? 0 : sequence - 1)), 0u);
  }
  for (uint64_t sequence = 5; sequence < 9; ++sequence) {
    EXPECT_EQ(queue.take().atlas->sequence, sequence);
  }
  EXPECT_EQ(queue.offer(chainedAtlas(9, 8)), 0u) << "also behind one that was taken";
}

TEST(AtlasQueue, refusesWhatRefersToAnAtlasThatTheReaderHasNotGot) {
  AtlasQueue queue;
  EXPECT_EQ(queue.offer(chainedAtlas(4, 3)), 0u) << "a reader that joins misses nothing";
  EXPECT_TRUE(queue.isStuck());
  EXPECT_EQ(queue.fallOutCount(), 0u);
  queue.offer(chainedAtlas(5, 0));
  EXPECT_FALSE(queue.isStuck());
  EXPECT_EQ(queue.offer(chainedAtlas(7, 6)), 1u);
  EXPECT_EQ(queue.offer(chainedAtlas(8, 7)), 1u);
  EXPECT_TRUE(queue.isStuck());
  EXPECT_EQ(queue.fallOutCount(), 1u);
  EXPECT_EQ(queue.take().atlas->sequence, 5u) << "what was kept still goes out";
  EXPECT_TRUE(queue.isEmpty());
  EXPECT_EQ(queue.offer(chainedAtlas(9, 0)), 0u);
  EXPECT_EQ(queue.offer(chainedAtlas(10, 9)), 0u);
}

TEST(AtlasQueue, isBoundedInBytes) {
  AtlasQueue queue;
  queue.offer(chainedAtlas(1, 0, kHalf));
  EXPECT_EQ(queue.offer(chainedAtlas(2, 1, 3 * kHalf)), 0u) << "two wait, however large";
  EXPECT_EQ(queue.offer(chainedAtlas(3, 2)), 1u);
  EXPECT_TRUE(queue.isStuck());
  queue.take();
  EXPECT_EQ(queue.offer(chainedAtlas(4, 3)), 1u) << "it has not got 3";
  EXPECT_EQ(queue.offer(chainedAtlas(5, 0, kHalf)), 1u) << "instead of 2";
  for (uint64_t sequence = 6; sequence < 9; ++sequence) {
    EXPECT_EQ(queue.offer(chainedAtlas(sequence, sequence - 1, kHalf / 4)), 0u);
  }
  EXPECT_FALSE(queue.isStuck());
}

TEST(AtlasQueue, isBoundedInAtlasesHoweverSmall) {
  AtlasQueue queue;
  for (uint64_t sequence = 1; sequence <= AtlasQueue::kWaitingMax; ++sequence) {
    EXPECT_EQ(queue.offer(chainedAtlas(sequence, sequence - 1, 1)), 0u);
  }
  EXPECT_FALSE(queue.isStuck());
  EXPECT_EQ(queue.offer(chainedAtlas(AtlasQueue::kWaitingMax + 1, AtlasQueue::kWaitingMax, 1)), 1u);
  EXPECT_TRUE(queue.isStuck());
}

TEST(AtlasQueue, followsAtlasesThatAreTakenBeforeTheyAreWhole) {
  AtlasQueue queue;
  const AtlasPtr first = chainedAtlas(1, 0);
  const AtlasPtr second = chainedAtlas(2, 1);
  EXPECT_FALSE(queue.mayBeNext(*second));
  ASSERT_TRUE(queue.mayBeNext(*first));
  queue.noteTaken(*first);
  EXPECT_TRUE(queue.mayBeNext(*second));
  queue.offer(second);
  EXPECT_FALSE(queue.mayBeNext(*chainedAtlas(3, 2))) << "2 goes first";
  queue.take();
  queue.noteTaken(*chainedAtlas(3, 2));
  queue.noteLost(3);
  EXPECT_EQ(queue.offer(chainedAtlas(4, 3)), 0u);
  EXPECT_TRUE(queue.isStuck()) << "3 was never whole";
}

TEST(FallOuts, areTooManyOnlyWithinAWhile) {
  FallOuts few;
  for (uint64_t count = 1; count <= 20; ++count) {
    EXPECT_FALSE(few.areTooMany(count, int64_t(count) * 4 * kSecond)) << count;
  }
  FallOuts many;
  for (uint64_t count = 1; count < FallOuts::kTooMany; ++count) {
    EXPECT_FALSE(many.areTooMany(count, int64_t(count) * kSecond)) << count;
  }
  EXPECT_TRUE(many.areTooMany(FallOuts::kTooMany, 5 * kSecond));
  many.forgive();
  EXPECT_FALSE(many.areTooMany(FallOuts::kTooMany + 1, 5 * kSecond));
}

}  // namespace
}  // namespace viewloom::test::atlas_queue_test
