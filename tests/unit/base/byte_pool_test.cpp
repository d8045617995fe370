// SPDX-License-Identifier: Apache-2.0
#include "base/byte_pool.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

#include "base/idle_memory.h"
#include "support/large_allocations.h"

namespace viewloom::byte_pool_test {
namespace {

TEST(BytePool, lendsTheSameMemoryAgain) {
  BytePool pool(2);
  BytePool::Buffer buffer = pool.take(100000);
  const uint8_t* memory = buffer->data();
  buffer->assign(100000, 7);
  buffer.reset();
  const BytePool::Buffer again = pool.take(100000);
  EXPECT_EQ(again->data(), memory);
  EXPECT_TRUE(again->empty());
}

TEST(BytePool, lendsMemoryAsItWasLeftToWhoeverWritesAllOfIt) {
  BytePool pool(2);
  BytePool::Buffer buffer = pool.takeAsLeft(1000);
  EXPECT_EQ(*buffer, std::vector<uint8_t>(1000, 0));
  const uint8_t* memory = buffer->data();
  buffer->assign(1000, 7);
  buffer.reset();
  buffer = pool.takeAsLeft(990);
  EXPECT_EQ(buffer->data(), memory);
  EXPECT_EQ(*buffer, std::vector<uint8_t>(990, 7));
  buffer.reset();
  buffer = pool.takeAsLeft(1000);
  EXPECT_EQ(buffer->size(), 1000u);
  buffer.reset();
  EXPECT_TRUE(pool.take(1000)->empty());
}

TEST(BytePool, findsTheSameMemoryForSizesThatVaryALittle) {
  BytePool pool(2);
  const uint8_t* memory = pool.take(1000000)->data();
  EXPECT_EQ(pool.take(1020000)->data(), memory);
  EXPECT_EQ(pool.take(990000)->data(), memory);
}

TEST(BytePool, keepsLargeBuffersForLargeRequests) {
  BytePool pool(2);
  const uint8_t* large = pool.take(1 << 20)->data();
  const BytePool::Buffer small = pool.take(1000);
  EXPECT_NE(small->data(), large);
  EXPECT_EQ(pool.take(1 << 20)->data(), large);
}

TEST(BytePool, takesTheSmallestThatFits) {
  BytePool pool(3);
  BytePool::Buffer middle = pool.take(2000);
  BytePool::Buffer large = pool.take(4000);
  BytePool::Buffer small = pool.take(1000);
  const uint8_t* memory = middle->data();
  for (BytePool::Buffer* buffer : {&large, &middle, &small}) buffer->reset();
  EXPECT_EQ(pool.take(1500)->data(), memory);
}

TEST(BytePool, forgetsTheBufferThatWaitedLongest) {
  BytePool pool(1);
  BytePool::Buffer first = pool.take(1000);
  BytePool::Buffer second = pool.take(100000);
  const uint8_t* memory = second->data();
  first.reset();
  second.reset();
  EXPECT_EQ(pool.take(100000)->data(), memory);
}

TEST(BytePool, keepsNoMoreMemoryThanItMay) {
  if (!test::countsLargeAllocations()) GTEST_SKIP() << "a sanitizer owns the heap";
  BytePool pool(8, 1 << 20);
  const auto allocates = [&pool](size_t capacity_bytes) {
    const uint64_t before = test::largeAllocationCount();
    pool.take(capacity_bytes);
    return test::largeAllocationCount() > before;
  };
  {
    const BytePool::Buffer first = pool.take(1 << 19);
    const BytePool::Buffer second = pool.take(1 << 19);
  }
  EXPECT_FALSE(allocates(1 << 19));
  EXPECT_TRUE(allocates(1 << 20));  // its return frees the two
  EXPECT_FALSE(allocates(1 << 20));
  EXPECT_TRUE(allocates(1 << 21));  // is not kept itself
  EXPECT_FALSE(allocates(1 << 20));
  EXPECT_TRUE(allocates(1 << 17));
}

TEST(BytePool, mayDieBeforeItsBuffers) {
  auto pool = std::make_unique<BytePool>(2);
  const BytePool::Buffer buffer = pool->take(1000);
  pool.reset();
  buffer->assign(1000, 1);
  EXPECT_EQ(buffer->back(), 1);
}

TEST(BytePool, neverLendsOneBufferTwice) {
  BytePool pool(8);
  std::vector<std::jthread> borrowers;
  for (uint8_t id = 0; id < 4; ++id) {
    borrowers.emplace_back([&pool, id] {
      for (int round = 0; round < 500; ++round) {
        const BytePool::Buffer buffer = pool.take(4096);
        buffer->assign(4096, id);
        EXPECT_EQ(*buffer, std::vector<uint8_t>(4096, id));
      }
    });
  }
}

TEST(BytePool, givesUpWhatWasNotUsedForSoLong) {
  BytePool pool(4);
  pool.take(1 << 20);
  const uint64_t held_bytes = pool.idleMemory()->idleBytes();
  EXPECT_GE(held_bytes, uint64_t{1} << 20);
  EXPECT_EQ(pool.idleMemory()->releaseIdle(std::chrono::hours(1)), 0u);
  const BytePool::Buffer lent = pool.take(1 << 20);
  EXPECT_EQ(pool.idleMemory()->idleBytes(), 0u) << "lent buffers are not idle";
  pool.take(1000);
  EXPECT_GE(pool.idleMemory()->releaseIdle(std::chrono::nanoseconds(0)), 1000u);
  EXPECT_EQ(pool.idleMemory()->idleBytes(), 0u);
}

TEST(BytePool, lendsNoBufferMuchLargerThanALargeRequest) {
  BytePool pool(4);
  pool.take(16 << 20);
  const BytePool::Buffer buffer = pool.take(4 << 20);
  EXPECT_LT(buffer->capacity(), size_t{8} << 20);
}

}  // namespace
}  // namespace viewloom::byte_pool_test
