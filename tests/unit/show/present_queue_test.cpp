// SPDX-License-Identifier: Apache-2.0
#include "show/present_queue.h"

#include <gtest/gtest.h>

namespace viewloom::show::present_queue_test {
namespace {

TEST(DueTime, isTheAtlassInTheNearFutureAndNowOtherwise) {
  EXPECT_EQ(dueTimeNs(0, 1000), 1000) << "at once";
  EXPECT_EQ(dueTimeNs(999, 1000), 1000) << "late";
  EXPECT_EQ(dueTimeNs(5000, 1000), 5000);
  EXPECT_EQ(dueTimeNs(1000 + kAheadMax_ns, 1000), 1000 + kAheadMax_ns);
  EXPECT_EQ(dueTimeNs(1001 + kAheadMax_ns, 1000), 1000) << "another clock";
}

TEST(PresentQueue, keepsAPictureUntilItIsDue) {
  PresentQueue<int> queue;
  EXPECT_EQ(queue.nextDueNs(), std::nullopt);
  queue.offer(1, 100);
  EXPECT_EQ(queue.nextDueNs(), 100);
  EXPECT_EQ(queue.take(99), std::nullopt);
  EXPECT_EQ(queue.take(100), 1);
  EXPECT_EQ(queue.take(100), std::nullopt);
  EXPECT_EQ(queue.droppedCount(), 0u);
}

TEST(PresentQueue, givesTheNewestThatIsDueAndCountsThoseItOvertook) {
  PresentQueue<int> queue;
  queue.offer(1, 100);
  queue.offer(2, 200);
  queue.offer(3, 300);
  EXPECT_EQ(queue.take(250), 2);
  EXPECT_EQ(queue.droppedCount(), 1u);
  EXPECT_EQ(queue.take(250), std::nullopt);
  EXPECT_EQ(queue.take(300), 3);
}

TEST(PresentQueue, whatCameLaterIsNewerEvenWhenItIsDueBefore) {
  PresentQueue<int> queue;
  queue.offer(1, 500);
  queue.offer(2, 100);
  EXPECT_EQ(queue.nextDueNs(), 100);
  EXPECT_EQ(queue.take(100), 2);
  EXPECT_EQ(queue.take(600), std::nullopt) << "an older picture after a newer one";
  EXPECT_EQ(queue.droppedCount(), 1u);
}

TEST(PresentQueue, aFourthPictureTakesTheOldestOnesPlace) {
  PresentQueue<int> queue;
  for (int picture = 1; picture <= 4; ++picture) queue.offer(picture, 100 * picture);
  EXPECT_EQ(queue.droppedCount(), 1u);
  EXPECT_EQ(queue.take(100), std::nullopt);
  EXPECT_EQ(queue.take(200), 2);
}

}  // namespace
}  // namespace viewloom::show::present_queue_test
