// SPDX-License-Identifier: Apache-2.0
#include "admission/memory_return.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

namespace viewloom::memory_return_test {
namespace {

constexpr uint64_t kMiB = uint64_t{1} << 20;

TEST(HeapWatch, returnsMemoryOnceItHasStayedFree) {
  HeapWatch heap;
  EXPECT_FALSE(heap.note({.used_bytes = 100 * kMiB}));
  EXPECT_FALSE(heap.note({.used_bytes = 100 * kMiB}));
  EXPECT_FALSE(heap.note({.used_bytes = 100 * kMiB}));
  EXPECT_FALSE(heap.note({.used_bytes = 10 * kMiB}));
  EXPECT_FALSE(heap.note({.used_bytes = 10 * kMiB}));
  EXPECT_TRUE(heap.note({.used_bytes = 10 * kMiB}));
  EXPECT_FALSE(heap.note({.used_bytes = 10 * kMiB}));
}

TEST(HeapWatch, leavesTheHeapToStreamsWhoseFramesComeAndGo) {
  HeapWatch heap;
  for (int i = 0; i < 50; ++i)
    EXPECT_FALSE(heap.note({.used_bytes = i % 2 == 0 ? 100 * kMiB : 10 * kMiB}));
}

// A compiler of kernels reserves nothing.
TEST(HeapWatch, returnsWhatNobodyHadReserved) {
  HeapWatch heap;
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(heap.note({.used_bytes = 350 * kMiB, .resident_bytes = 150 * kMiB}));
  }
  EXPECT_FALSE(heap.note({.used_bytes = 350 * kMiB, .resident_bytes = 400 * kMiB}));
  EXPECT_FALSE(heap.note({.used_bytes = 350 * kMiB, .resident_bytes = 300 * kMiB}));
  EXPECT_TRUE(heap.note({.used_bytes = 350 * kMiB, .resident_bytes = 300 * kMiB}));
  // Kernels stay: there is nothing more to be had.
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(heap.note({.used_bytes = 350 * kMiB, .resident_bytes = 200 * kMiB}));
  }
}

TEST(HeapWatch, leavesTheHeapToStreamsThatKeepIt) {
  HeapWatch heap;
  for (int i = 0; i < 50; ++i) {
    EXPECT_FALSE(heap.note(
        {.used_bytes = i % 2 == 0 ? 100 * kMiB : 10 * kMiB, .resident_bytes = 160 * kMiB}));
  }
}

TEST(HeapWatch, waitsForAsMuchAsIsWorthIt) {
  HeapWatch heap;
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(heap.note({.used_bytes = 100 * kMiB}));
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(heap.note({.used_bytes = 85 * kMiB}));
}

TEST(HeapWatch, returnsWhatWasGivenUpAtOnce) {
  HeapWatch heap;
  EXPECT_FALSE(heap.note({.used_bytes = 100 * kMiB, .released_bytes = 10 * kMiB}));
  EXPECT_TRUE(heap.note({.used_bytes = 90 * kMiB, .released_bytes = 10 * kMiB}));
}

TEST(HeapWatch, pausesBetweenTwoWalks) {
  HeapWatch heap;
  size_t walk_count = 0;
  for (int i = 0; i < 30; ++i) {
    walk_count += heap.note({.used_bytes = 100 * kMiB, .released_bytes = 50 * kMiB});
  }
  EXPECT_EQ(walk_count, 30 / HeapWatch::kLooks);
}

TEST(MemoryReturn, ticksAndEndsAtOnce) {
  MemoryBudget budget(1000);
  std::atomic<int> tick_count = 0;
  {
    const MemoryReturn memory_return(budget, [&] {
      ++tick_count;
      return uint64_t{0};
    });
    while (tick_count == 0) std::this_thread::yield();
  }
  EXPECT_GE(tick_count, 1);
}

TEST(MemoryReturn, goesOnAfterAnException) {
  MemoryBudget budget(1000);
  std::atomic<int> tick_count = 0;
  const MemoryReturn memory_return(budget, [&] {
    if (++tick_count == 1) throw std::runtime_error("planted");
    return uint64_t{0};
  });
  while (tick_count < 2) std::this_thread::yield();
}

}  // namespace
}  // namespace viewloom::memory_return_test
