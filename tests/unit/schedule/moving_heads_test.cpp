// SPDX-License-Identifier: Apache-2.0
// Which of the heads that move is next, by hand.
#include <gtest/gtest.h>

#include "schedule/job_queue.h"
#include "unit/schedule/head_jobs.h"

namespace viewloom::moving_heads_test {
namespace {

TEST(JobQueueOfMovingHeads, takesEyesThatHaveJustMovedBeforeThoseThatSoonWill) {
  JobQueue queue;
  queue.push(jobOf("will", {.received_ns = 0, .interval_ns = 10 * kMs_ns}, 1));
  queue.push(jobOf("has", {.received_ns = 5 * kMs_ns, .interval_ns = 10 * kMs_ns}, 2));
  EXPECT_EQ(queue.beginTracked(6 * kMs_ns).picture_key, "has");
  EXPECT_EQ(queue.beginTracked(6 * kMs_ns).picture_key, "will") << "nobody else waits";
}

TEST(JobQueueOfMovingHeads, knowsTheNewestPosesOfThoseThatWait) {
  JobQueue queue;
  queue.push(jobOf("first", {.received_ns = 0, .interval_ns = 10 * kMs_ns}, 1));
  queue.push(jobOf("second", {.received_ns = 1 * kMs_ns, .interval_ns = 10 * kMs_ns}, 2));
  queue.push(jobOf("first", {.received_ns = 10 * kMs_ns, .interval_ns = 10 * kMs_ns}, 3));
  EXPECT_EQ(queue.beginTracked(10 * kMs_ns).picture_key, "first");
}

TEST(JobQueueOfMovingHeads, takesWhoHasWaitedLongestOfThoseWithFreshPoses) {
  JobQueue queue;
  queue.push(jobOf("stale", {.received_ns = 2 * kMs_ns, .interval_ns = 10 * kMs_ns}, 1));
  queue.push(jobOf("freshest", {.received_ns = 9 * kMs_ns, .interval_ns = 10 * kMs_ns}, 3));
  queue.push(jobOf("fresh", {.received_ns = 8 * kMs_ns, .interval_ns = 10 * kMs_ns}, 2));
  EXPECT_EQ(queue.beginTracked(9 * kMs_ns).picture_key, "fresh");
}

TEST(JobQueueOfMovingHeads, takesPosesOfOneInstantInTurn) {
  JobQueue queue;
  queue.push(jobOf("a", {.received_ns = 10, .interval_ns = kHeadset_ns}, 1));
  queue.push(jobOf("b", {.received_ns = 20, .interval_ns = kHeadset_ns}, 2));
  EXPECT_EQ(queue.beginTracked(kHeadset_ns - 1).picture_key, "a");
}

TEST(JobQueueOfMovingHeads, expectsNoPosesOfWhoHasFallenSilent) {
  JobQueue queue;
  queue.push(jobOf("silent", {.received_ns = 0, .interval_ns = 10 * kMs_ns}, 1));
  queue.push(jobOf("moves", {.received_ns = 21 * kMs_ns, .interval_ns = 10 * kMs_ns}, 2));
  EXPECT_EQ(queue.beginTracked(21 * kMs_ns).picture_key, "silent");
}

TEST(JobQueueOfMovingHeads, expectsNoPosesOfWhomItDoesNotKnow) {
  JobQueue queue;
  queue.push(jobOf("came", {.received_ns = 0, .interval_ns = 0}, 1));
  queue.push(jobOf("moves", {.received_ns = 9 * kMs_ns, .interval_ns = 10 * kMs_ns}, 2));
  EXPECT_EQ(queue.beginTracked(9 * kMs_ns).picture_key, "came");
}

TEST(JobQueueOfMovingHeads, letsOthersBeforeOneSoOftenAndNoMore) {
  JobQueue queue;
  queue.push(jobOf("stale", {.received_ns = 0, .interval_ns = kSecond_ns}, 0));
  for (int64_t i = 0; i < 2 * (kRoundsPassed + 1); ++i) {
    const int64_t now_ns = (500 + i) * kMs_ns;
    queue.push(jobOf("fresh", {.received_ns = now_ns, .interval_ns = kMs_ns}, now_ns));
    ASSERT_EQ(queue.beginTracked(now_ns).picture_key, "fresh") << i;
    queue.finish("fresh");
  }
  const int64_t now_ns = 600 * kMs_ns;
  queue.push(jobOf("fresh", {.received_ns = now_ns, .interval_ns = kMs_ns}, now_ns));
  EXPECT_EQ(queue.beginTracked(now_ns).picture_key, "stale");
}

TEST(JobQueueOfMovingHeads, waitsForPosesThatAreDueSoonerThanTheNewestHaveAged) {
  JobQueue queue;
  queue.push(jobOf("a", {.received_ns = 0, .interval_ns = 10 * kMs_ns}, 1));
  queue.push(jobOf("b", {.received_ns = 2 * kMs_ns, .interval_ns = 20 * kMs_ns}, 2));
  EXPECT_EQ(queue.eyesWaitUntilNs(7 * kMs_ns), std::nullopt) << "too long for others";
  EXPECT_EQ(queue.eyesWaitUntilNs(8 * kMs_ns), 10 * kMs_ns + kAlikePoses_ns);
  queue.push(jobOf("a", {.received_ns = 10 * kMs_ns, .interval_ns = 10 * kMs_ns}, 3));
  EXPECT_EQ(queue.eyesWaitUntilNs(10 * kMs_ns), std::nullopt) << "they have come";
}

TEST(JobQueueOfMovingHeads, waitsForWhoHasWaitedLongestThoughOthersHaveFreshPoses) {
  JobQueue queue;
  queue.push(jobOf("longest", {.received_ns = 0, .interval_ns = 10 * kMs_ns}, 1));
  queue.push(jobOf("fresh", {.received_ns = 9 * kMs_ns, .interval_ns = 10 * kMs_ns}, 2));
  EXPECT_EQ(queue.eyesWaitUntilNs(9 * kMs_ns), 10 * kMs_ns + kAlikePoses_ns);
  queue.push(jobOf("longest", {.received_ns = 10 * kMs_ns, .interval_ns = 10 * kMs_ns}, 3));
  EXPECT_EQ(queue.eyesWaitUntilNs(10 * kMs_ns), std::nullopt);
  EXPECT_EQ(queue.beginTracked(10 * kMs_ns).picture_key, "longest");
}

TEST(JobQueueOfMovingHeads, waitsNoLongerForPosesThatDoNotCome) {
  JobQueue queue;
  queue.push(jobOf("silent", {.received_ns = 0, .interval_ns = 10 * kMs_ns}, 1));
  EXPECT_TRUE(queue.eyesWaitUntilNs(10 * kMs_ns).has_value()) << "a little late";
  EXPECT_EQ(queue.eyesWaitUntilNs(10 * kMs_ns + kAlikePoses_ns), std::nullopt);
}

TEST(JobQueueOfMovingHeads, doesNotWaitWhereItCannotPay) {
  JobQueue queue;
  queue.push(jobOf("flood", {.received_ns = 0, .interval_ns = kMs_ns / 10}, 1));
  EXPECT_EQ(queue.eyesWaitUntilNs(kMs_ns / 11), std::nullopt) << "as good as the next";
  JobQueue first;
  first.push(jobOf("first", {.received_ns = 0, .interval_ns = 0}, 1));
  EXPECT_EQ(first.eyesWaitUntilNs(9 * kMs_ns), std::nullopt) << "nothing says when more come";
  JobQueue slow;
  slow.push(jobOf("slow", {.received_ns = 0, .interval_ns = kSecond_ns}, 1));
  EXPECT_EQ(slow.eyesWaitUntilNs(kSecond_ns - kAwaited_ns), std::nullopt) << "too long for others";
  EXPECT_TRUE(slow.eyesWaitUntilNs(kSecond_ns - kAwaited_ns + 1).has_value());
}

TEST(JobQueueOfMovingHeads, doesNotWaitWithANewFrame) {
  JobQueue queue;
  AtlasJob job = jobOf("sees", {.received_ns = 0, .interval_ns = 10 * kMs_ns}, 1);
  job.is_for_eyes = false;
  queue.push(job);
  EXPECT_EQ(queue.eyesWaitUntilNs(9 * kMs_ns), std::nullopt);
}

TEST(JobQueueOfMovingHeads, waitsForNobodyWhosePosesAnAtlasOnItsWayHasTaken) {
  constexpr PoseTimes kPoses{.received_ns = 8 * kMs_ns, .interval_ns = 10 * kMs_ns};
  JobQueue queue;
  queue.push(jobOf("served", kPoses, 1));
  ASSERT_EQ(queue.beginTracked(0).picture_key, "served");
  queue.push(jobOf("served", kPoses, 2));
  queue.forgetEyes("served");
  queue.finish("served");
  AtlasJob with_frame = jobOf("sees", kPoses, 3);
  with_frame.is_for_eyes = false;
  queue.push(with_frame);
  queue.forgetEyes("sees");
  EXPECT_TRUE(queue.isBusy("sees")) << "there is a frame to show";
}

// A head that was passed over for too long is next. The queue waits only for its newest poses.
TEST(JobQueueOfMovingHeads, waitsForThePosesOfOneThatWasPassedOverForTooLong) {
  JobQueue queue;
  queue.push(jobOf("stale", {.received_ns = 0, .interval_ns = kSecond_ns}, 0));
  const auto pushFresh = [&](int64_t now_ns) {
    queue.push(jobOf("fresh", {.received_ns = now_ns, .interval_ns = 2 * kMs_ns}, now_ns));
  };
  for (int64_t i = 0; i < 2 * kRoundsPassed; ++i) {
    pushFresh((500 + i) * kMs_ns);
    ASSERT_EQ(queue.beginTracked((500 + i) * kMs_ns).picture_key, "fresh") << i;
    queue.finish("fresh");
  }
  pushFresh(995 * kMs_ns);
  EXPECT_EQ(queue.eyesWaitUntilNs(995 * kMs_ns), kSecond_ns + kAlikePoses_ns);
  queue.push(jobOf("stale", {.received_ns = kSecond_ns, .interval_ns = kSecond_ns}, 0));
  EXPECT_EQ(queue.eyesWaitUntilNs(kSecond_ns), std::nullopt);
  EXPECT_EQ(queue.beginTracked(kSecond_ns).picture_key, "stale");
}

}  // namespace
}  // namespace viewloom::moving_heads_test
