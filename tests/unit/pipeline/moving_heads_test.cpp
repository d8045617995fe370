// SPDX-License-Identifier: Apache-2.0
// Which of the heads that move is next: by hand, and before a server that has too few answers.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/job_queue.h"
#include "pipeline/resident_structure.h"

namespace viewloom {
namespace {

constexpr int64_t kMs_ns = 1'000'000;
constexpr int64_t kSecond_ns = 1000 * kMs_ns;
constexpr int64_t kHeadset_ns = kSecond_ns / 90;

ResidentPtr someStructure() {
  static const auto structure = std::make_shared<const ResidentStructure>();
  return structure;
}

AtlasJob jobOf(const std::string& head, const PoseTimes& poses, int64_t deadline_ns) {
  return {.picture_key = head,
          .structure = someStructure(),
          .deadline_ns = deadline_ns,
          .is_for_eyes = true,
          .is_tracked = true,
          .poses = poses};
}

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

// Who is next in any case takes its own newest poses, and waits for those alone.
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

// Poses of one client, at even times.
struct Head {
  int64_t interval_ns = kHeadset_ns;
  int64_t phase_ns = 0;
};

constexpr int64_t kServed_ns = 60 * kSecond_ns;

// What heads were answered by a server that makes one answer at a time.
struct Served {
  std::vector<int64_t> ages_ns;  // of the poses, when their answer began
  size_t passed_count_max = 0;   // answers to others that began while one head waited

  int64_t ageNs(double share) const {
    std::vector<int64_t> sorted = ages_ns;
    std::sort(sorted.begin(), sorted.end());
    return sorted[size_t(share * double(sorted.size() - 1))];
  }
  // Of the time, so much was spent on answers.
  double busyShare(int64_t answer_ns) const {
    return double(answer_ns) * double(ages_ns.size()) / double(kServed_ns);
  }
};

Served serve(const std::vector<Head>& heads, int64_t answer_ns) {
  JobQueue queue;
  std::vector<int64_t> next_ns, newest_ns(heads.size());
  std::vector<size_t> passed_count(heads.size());
  for (const Head& head : heads) next_ns.push_back(head.phase_ns);
  Served served;
  // An answer takes a little more or less each time: nothing stays in step.
  std::mt19937 random(1);
  std::uniform_int_distribution<int64_t> more_ns(-answer_ns / 20, answer_ns / 20);
  std::vector<bool> waits(heads.size());
  int64_t now_ns = 0;
  while (now_ns < kServed_ns) {
    for (size_t i = 0; i < heads.size(); ++i) {
      for (; next_ns[i] <= now_ns; next_ns[i] += heads[i].interval_ns) {
        newest_ns[i] = next_ns[i];
        waits[i] = true;
        queue.push(jobOf(std::to_string(i), {newest_ns[i], heads[i].interval_ns}, newest_ns[i]));
      }
    }
    if (!queue.hasTracked()) {
      now_ns = *std::min_element(next_ns.begin(), next_ns.end());
      continue;
    }
    if (const auto until_ns = queue.eyesWaitUntilNs(now_ns)) {
      now_ns = std::min(*until_ns, *std::min_element(next_ns.begin(), next_ns.end()));
      continue;
    }
    const std::string key = queue.beginTracked(now_ns).picture_key;
    const size_t head = std::stoul(key);
    served.ages_ns.push_back(now_ns - newest_ns[head]);
    waits[head] = false;
    passed_count[head] = 0;
    for (size_t i = 0; i < heads.size(); ++i) {
      if (waits[i]) ++passed_count[i];
      served.passed_count_max = std::max(served.passed_count_max, passed_count[i]);
    }
    now_ns += answer_ns + more_ns(random);
    queue.finish(key);
  }
  return served;
}

constexpr size_t kHeadCount = 8;
// So that 2.4 of eight heads at 90 Hz can be answered each time.
constexpr int64_t kAnswer_ns = 4'670'000;

TEST(JobQueueOfMovingHeads, answersFreshPosesOfHeadsThatMoveEachAtItsOwnTime) {
  std::vector<Head> heads(kHeadCount);
  for (size_t i = 0; i < heads.size(); ++i) {
    const double turns = double(i) * std::numbers::phi;
    heads[i].phase_ns = int64_t((turns - std::floor(turns)) * double(kHeadset_ns));
  }
  const Served served = serve(heads, kAnswer_ns);
  EXPECT_LE(served.ageNs(0.5), kHeadset_ns / 16);
  EXPECT_LE(served.ageNs(0.99), kHeadset_ns / 8);
  EXPECT_GE(served.busyShare(kAnswer_ns), 0.9) << "waits cost more than they should";
}

TEST(JobQueueOfMovingHeads, answersHeadsThatMoveAtOnceInTurn) {
  const Served served = serve(std::vector<Head>(kHeadCount), kAnswer_ns);
  EXPECT_LE(served.passed_count_max, kHeadCount);
}

// Who waits for the poses of some keeps the phase of these: another's need never be near it.
TEST(JobQueueOfMovingHeads, answersOneWhosePosesNeverComeWhenSomebodyIsNext) {
  constexpr int64_t kInterval_ns = kSecond_ns / 60;
  const Served served =
      serve({{kInterval_ns, 0}, {kInterval_ns, 6'000'000}, {kInterval_ns, 6'200'000}}, 15'500'000);
  EXPECT_LT(served.passed_count_max, (kRoundsPassed + 2) * 3);
}

TEST(JobQueueOfMovingHeads, answersEverybodyWhateverTheirPhasesAndRates) {
  std::mt19937 random(2026);
  std::uniform_real_distribution<double> share(0, 1);
  for (int turn = 0; turn < 50; ++turn) {
    SCOPED_TRACE(turn);
    std::vector<Head> heads(kHeadCount);
    int64_t longest_ns = 0;
    for (Head& head : heads) {
      if (turn % 2 == 1) head.interval_ns = int64_t(double(kSecond_ns) / (60 + 84 * share(random)));
      head.phase_ns = int64_t(share(random) * double(head.interval_ns));
      longest_ns = std::max(longest_ns, head.interval_ns);
    }
    const Served served = serve(heads, kAnswer_ns);
    EXPECT_LT(served.passed_count_max, (kRoundsPassed + 2) * kHeadCount);
    EXPECT_LE(served.ageNs(0.5), longest_ns / 8);
    EXPECT_LE(served.ageNs(0.99), longest_ns / 2);
    EXPECT_GE(served.busyShare(kAnswer_ns), 0.6);
  }
}

}  // namespace
}  // namespace viewloom
