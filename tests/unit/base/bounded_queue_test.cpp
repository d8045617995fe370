// SPDX-License-Identifier: Apache-2.0
#include "base/bounded_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>
#include <vector>

namespace viewloom::bounded_queue_test {
namespace {

TEST(BoundedQueue, handsOutInTheOrderOfArrival) {
  BoundedQueue<int> queue(3);
  for (const int item : {1, 2, 3}) EXPECT_TRUE(queue.push(item));
  for (const int item : {1, 2, 3}) EXPECT_EQ(queue.pop(), item);
}

TEST(BoundedQueue, refusesWhenClosedButHandsOutWhatIsInside) {
  BoundedQueue<int> queue(3);
  queue.push(1);
  queue.close();
  EXPECT_FALSE(queue.push(2));
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), std::nullopt);
}

TEST(BoundedQueue, letsAWaitingProducerGoWhenClosed) {
  BoundedQueue<int> queue(1);
  queue.push(1);
  std::future<bool> pushed = std::async(std::launch::async, [&] { return queue.push(2); });
  queue.close();
  EXPECT_FALSE(pushed.get());
}

TEST(BoundedQueue, neverHoldsMoreThanItsCapacity) {
  constexpr int kCapacity = 4;
  constexpr int kItems = 5000;
  BoundedQueue<int> queue(kCapacity);
  std::atomic<int> pushed_count = 0;
  std::jthread producer([&] {
    for (int i = 0; i < kItems; ++i) {
      queue.push(i);
      ++pushed_count;
    }
    queue.close();
  });
  int popped_count = 0;
  while (const std::optional<int> item = queue.pop()) {
    EXPECT_EQ(*item, popped_count);
    ++popped_count;
    EXPECT_LE(pushed_count, popped_count + kCapacity);
  }
  EXPECT_EQ(popped_count, kItems);
}

}  // namespace
}  // namespace viewloom::bounded_queue_test
