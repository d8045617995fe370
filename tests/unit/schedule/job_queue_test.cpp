// SPDX-License-Identifier: Apache-2.0
#include "schedule/job_queue.h"

#include <gtest/gtest.h>

#include "base/cost_estimate.h"
#include "schedule/resident_structure.h"

namespace viewloom::job_queue_test {
namespace {

// Each newer than the one before.
ResidentPtr someStructure() {
  static uint64_t last_serial = 0;
  auto structure = std::make_shared<ResidentStructure>();
  structure->serial = ++last_serial;
  return structure;
}

// Nobody has had any time of these.
const FairShares kShares;

AtlasJob begin(JobQueue& queue) {
  return queue.begin(*queue.next(kShares));
}

bool hasNext(const JobQueue& queue) {
  return queue.next(kShares) != nullptr;
}

TEST(JobQueue, givesTheSoonestDeadlineFirstWhereSharesAreEqual) {
  JobQueue queue;
  queue.push({"late", someStructure(), 30, nullptr});
  queue.push({"soon", someStructure(), 10, nullptr});
  queue.push({"middle", someStructure(), 20, nullptr});
  EXPECT_EQ(begin(queue).picture_key, "soon");
  EXPECT_EQ(begin(queue).picture_key, "middle");
  EXPECT_EQ(begin(queue).picture_key, "late");
  EXPECT_FALSE(hasNext(queue));
}

TEST(JobQueue, givesTheJobOfWhomHadLessFirst) {
  FairShares shares;
  JobQueue queue;
  AtlasJob greedy{"greedy", someStructure(), 10, nullptr};
  greedy.payers = {Payer("10.0.0.1")};
  AtlasJob modest{"modest", someStructure(), 20, nullptr};
  modest.payers = {Payer("10.0.0.2")};
  shares.begin(claimOf(greedy), kPiece_ns);
  queue.push(greedy);
  queue.push(modest);
  EXPECT_EQ(queue.next(shares)->display, "modest");
  EXPECT_EQ(queue.next(shares, {.all = {modest.payers}, .tracked = {}})->display, "greedy");
  EXPECT_EQ(queue.next(shares, {.all = {}, .tracked = {modest.payers}})->display, "modest");
}

TEST(JobQueue, letsWhoeverJoinsAPicturePayForIt) {
  FairShares shares;
  JobQueue queue;
  const ResidentPtr structure = someStructure();
  AtlasJob of_greedy{"shared", structure, 20, nullptr};
  of_greedy.payers = {Payer("10.0.0.1")};
  AtlasJob of_both = of_greedy;
  of_both.payers.push_back(Payer("10.0.0.2"));
  AtlasJob of_third{"other", someStructure(), 10, nullptr};
  of_third.payers = {Payer("10.0.0.3")};
  shares.begin(claimOf(of_third), kPiece_ns);
  shares.begin(claimOf(of_greedy), 2 * kPiece_ns);
  queue.push(of_greedy);
  queue.push(of_third);
  EXPECT_EQ(queue.next(shares)->display, "other");
  queue.push(of_both);
  EXPECT_EQ(queue.next(shares)->display, "shared");
}

TEST(JobQueue, replacesAJobOfTheSamePictureThatHasNotBegun) {
  JobQueue queue;
  const ResidentPtr older = someStructure();
  const ResidentPtr newer = someStructure();
  EXPECT_FALSE(queue.push({"quilt", older, 10, nullptr}).has_value());
  const auto replaced = queue.push({"quilt", newer, 20, nullptr});
  ASSERT_TRUE(replaced.has_value());
  EXPECT_EQ(replaced->structure, older);
  EXPECT_EQ(begin(queue).structure, newer);
  EXPECT_FALSE(hasNext(queue));
}

TEST(JobQueue, keepsTheNewerStructureWhicheverComesFirst) {
  JobQueue queue;
  const ResidentPtr older = someStructure();
  const ResidentPtr newer = someStructure();
  queue.push({"quilt", newer, 10, nullptr});
  const auto refused = queue.push({"quilt", older, 5, nullptr});
  ASSERT_TRUE(refused.has_value());
  EXPECT_EQ(refused->structure, older);
  EXPECT_EQ(begin(queue).structure, newer);
}

TEST(JobQueue, keepsTheSoonerDeadlineSoThatFastStreamsDoNotPutAPictureOffForEver) {
  JobQueue queue;
  queue.push({"large", someStructure(), 50, nullptr});
  for (int64_t deadline_ns = 60; deadline_ns < 100; deadline_ns += 10) {
    queue.push({"large", someStructure(), deadline_ns, nullptr});
  }
  EXPECT_EQ(queue.next(kShares)->deadline_ns, 50);
}

TEST(JobQueue, mergesJobsForTheSameStructureAndKeepsItsTicket) {
  JobQueue queue;
  const ResidentPtr structure = someStructure();
  const auto ticket = std::make_shared<FrameTicket>(1, nullptr);
  EXPECT_FALSE(queue.push({"quilt", structure, 10, nullptr}).has_value());
  EXPECT_FALSE(queue.push({"quilt", structure, 20, ticket}).has_value());
  EXPECT_FALSE(queue.push({"quilt", structure, 30, nullptr}).has_value());
  EXPECT_EQ(begin(queue).ticket, ticket);
}

TEST(JobQueue, keepsAJobThatIsNotForEyesAloneAsThat) {
  for (const bool eyes_come_first : {false, true}) {
    JobQueue queue;
    const ResidentPtr structure = someStructure();
    queue.push({"tracked", structure, 10, nullptr, eyes_come_first});
    queue.push({"tracked", structure, 20, nullptr, !eyes_come_first});
    EXPECT_FALSE(begin(queue).is_for_eyes);
    EXPECT_FALSE(hasNext(queue));
    queue.push({"tracked", structure, 10, nullptr, true});
    queue.push({"tracked", structure, 20, nullptr, true});
    EXPECT_FALSE(hasNext(queue)) << "the picture is being traced";
    queue.finish("tracked");
    EXPECT_TRUE(begin(queue).is_for_eyes);
  }
}

TEST(JobQueue, finishesABegunPictureBeforeANewerOneOfItBegins) {
  JobQueue queue;
  queue.push({"quilt", someStructure(), 10, nullptr});
  queue.push({"stereo", someStructure(), 40, nullptr});
  ASSERT_EQ(begin(queue).picture_key, "quilt");
  const ResidentPtr newer = someStructure();
  EXPECT_FALSE(queue.push({"quilt", newer, 20, nullptr}).has_value()) << "a begun job stays";
  EXPECT_EQ(begin(queue).picture_key, "stereo") << "the sooner quilt must wait for itself";
  EXPECT_FALSE(hasNext(queue));
  queue.finish("quilt");
  EXPECT_EQ(begin(queue).structure, newer);
}

TEST(JobQueue, givesEyesFirstUnlessTheyWaitForTheirOwnLastAtlas) {
  JobQueue queue;
  queue.push({"quilt", someStructure(), 10, nullptr});
  const ResidentPtr structure = someStructure();
  queue.push({"eyes", structure, 500, nullptr, true, true});
  ASSERT_EQ(begin(queue).picture_key, "eyes");
  queue.push({"eyes", structure, 500, nullptr, true, true});
  EXPECT_EQ(queue.next(kShares)->display, "quilt");
  queue.finish("eyes");
  EXPECT_EQ(queue.next(kShares)->display, "eyes");
}

TEST(JobQueue, handsBackWhatHasNotBegun) {
  JobQueue queue;
  queue.push({"begun", someStructure(), 10, nullptr});
  queue.push({"waiting", someStructure(), 20, nullptr});
  begin(queue);
  const auto waiting = queue.clear();
  ASSERT_EQ(waiting.size(), 1u);
  EXPECT_EQ(waiting[0].picture_key, "waiting");
  EXPECT_FALSE(hasNext(queue));
}

}  // namespace
}  // namespace viewloom::job_queue_test
