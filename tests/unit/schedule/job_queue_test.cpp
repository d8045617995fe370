// SPDX-License-Identifier: Apache-2.0
#include "schedule/job_queue.h"

#include <gtest/gtest.h>

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

TEST(JobQueue, givesTheSoonestDeadlineFirst) {
  JobQueue queue;
  queue.push({"late", someStructure(), 30, nullptr});
  queue.push({"soon", someStructure(), 10, nullptr});
  queue.push({"middle", someStructure(), 20, nullptr});
  EXPECT_EQ(queue.soonestDeadlineNs(), 10);
  EXPECT_EQ(queue.begin().picture_key, "soon");
  EXPECT_EQ(queue.begin().picture_key, "middle");
  EXPECT_EQ(queue.begin().picture_key, "late");
  EXPECT_EQ(queue.soonestDeadlineNs(), std::nullopt);
}

TEST(JobQueue, replacesAJobOfTheSamePictureThatHasNotBegun) {
  JobQueue queue;
  const ResidentPtr older = someStructure();
  const ResidentPtr newer = someStructure();
  EXPECT_FALSE(queue.push({"quilt", older, 10, nullptr}).has_value());
  const auto replaced = queue.push({"quilt", newer, 20, nullptr});
  ASSERT_TRUE(replaced.has_value());
  EXPECT_EQ(replaced->structure, older);
  EXPECT_EQ(queue.begin().structure, newer);
  EXPECT_FALSE(queue.soonestDeadlineNs().has_value());
}

TEST(JobQueue, keepsTheNewerStructureWhicheverComesFirst) {
  JobQueue queue;
  const ResidentPtr older = someStructure();
  const ResidentPtr newer = someStructure();
  queue.push({"quilt", newer, 10, nullptr});
  const auto refused = queue.push({"quilt", older, 5, nullptr});
  ASSERT_TRUE(refused.has_value());
  EXPECT_EQ(refused->structure, older);
  EXPECT_EQ(queue.begin().structure, newer);
}

TEST(JobQueue, keepsTheSoonerDeadlineSoThatFastStreamsDoNotPutAPictureOffForEver) {
  JobQueue queue;
  queue.push({"large", someStructure(), 50, nullptr});
  for (int64_t deadline_ns = 60; deadline_ns < 100; deadline_ns += 10) {
    queue.push({"large", someStructure(), deadline_ns, nullptr});
  }
  EXPECT_EQ(queue.soonestDeadlineNs(), 50);
}

TEST(JobQueue, mergesJobsForTheSameStructureAndKeepsItsTicket) {
  JobQueue queue;
  const ResidentPtr structure = someStructure();
  const auto ticket = std::make_shared<FrameTicket>(1, nullptr);
  EXPECT_FALSE(queue.push({"quilt", structure, 10, nullptr}).has_value());
  EXPECT_FALSE(queue.push({"quilt", structure, 20, ticket}).has_value());
  EXPECT_FALSE(queue.push({"quilt", structure, 30, nullptr}).has_value());
  EXPECT_EQ(queue.begin().ticket, ticket);
}

TEST(JobQueue, keepsAJobThatIsNotForEyesAloneAsThat) {
  for (const bool eyes_come_first : {false, true}) {
    JobQueue queue;
    const ResidentPtr structure = someStructure();
    queue.push({"tracked", structure, 10, nullptr, eyes_come_first});
    queue.push({"tracked", structure, 20, nullptr, !eyes_come_first});
    EXPECT_FALSE(queue.begin().is_for_eyes);
    EXPECT_FALSE(queue.soonestDeadlineNs().has_value());
    queue.push({"tracked", structure, 10, nullptr, true});
    queue.push({"tracked", structure, 20, nullptr, true});
    EXPECT_EQ(queue.soonestDeadlineNs(), std::nullopt) << "the picture is being traced";
    queue.finish("tracked");
    EXPECT_TRUE(queue.begin().is_for_eyes);
  }
}

TEST(JobQueue, finishesABegunPictureBeforeANewerOneOfItBegins) {
  JobQueue queue;
  queue.push({"quilt", someStructure(), 10, nullptr});
  queue.push({"stereo", someStructure(), 40, nullptr});
  ASSERT_EQ(queue.begin().picture_key, "quilt");
  const ResidentPtr newer = someStructure();
  EXPECT_FALSE(queue.push({"quilt", newer, 20, nullptr}).has_value()) << "a begun job stays";
  EXPECT_EQ(queue.begin().picture_key, "stereo") << "the sooner quilt must wait for itself";
  EXPECT_EQ(queue.soonestDeadlineNs(), std::nullopt);
  queue.finish("quilt");
  EXPECT_EQ(queue.begin().structure, newer);
}

TEST(JobQueue, tellsWhetherEyesWait) {
  JobQueue queue;
  queue.push({"quilt", someStructure(), 10, nullptr});
  EXPECT_FALSE(queue.hasTracked());
  const ResidentPtr structure = someStructure();
  queue.push({"eyes", structure, 5, nullptr, true, true});
  EXPECT_TRUE(queue.hasTracked());
  ASSERT_EQ(queue.begin().picture_key, "eyes");
  queue.push({"eyes", structure, 5, nullptr, true, true});
  EXPECT_FALSE(queue.hasTracked()) << "they wait for their own last atlas";
  queue.finish("eyes");
  EXPECT_TRUE(queue.hasTracked());
}

TEST(JobQueue, handsBackWhatHasNotBegun) {
  JobQueue queue;
  queue.push({"begun", someStructure(), 10, nullptr});
  queue.push({"waiting", someStructure(), 20, nullptr});
  queue.begin();
  const auto waiting = queue.clear();
  ASSERT_EQ(waiting.size(), 1u);
  EXPECT_EQ(waiting[0].picture_key, "waiting");
  EXPECT_FALSE(queue.soonestDeadlineNs().has_value());
}

}  // namespace
}  // namespace viewloom::job_queue_test
