// SPDX-License-Identifier: Apache-2.0
// Which job an engine begins next, by a clock that is turned by hand.
#include "schedule/job_board.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "unit/schedule/head_jobs.h"

namespace viewloom::job_board_test {
namespace {

constexpr size_t kFirst = 0;
constexpr size_t kSecond = 1;

AtlasJob quilt(const std::string& picture_key, int64_t deadline_ns, uint64_t serial = 1) {
  auto structure = std::make_shared<ResidentStructure>();
  structure->serial = serial;
  return {.picture_key = picture_key, .structure = structure, .deadline_ns = deadline_ns};
}

class JobBoardTest : public testing::Test {
 protected:
  // Poses that came just now, after those of a headset's interval ago.
  AtlasJob eyes() const {
    return jobOf("eyes", {.received_ns = clock_.nowNs(), .interval_ns = kHeadset_ns}, 0);
  }
  // "" where none may begin.
  std::string begin(size_t engine, const Claim* first_begun = nullptr, bool has_room = true) {
    const std::optional<AtlasJob> job =
        board_.begin(engine, first_begun, [has_room](const Payers&) { return has_room; });
    return job ? job->picture_key : "";
  }
  std::optional<AtlasJob> beginFirst() {
    return board_.begin(kFirst, nullptr, [](const Payers&) { return true; });
  }

  ManualClock clock_;
  FairShares shares_;
  JobBoard board_{clock_, shares_, 2};
};

TEST_F(JobBoardTest, isNewsOnceUntilThePictureBegins) {
  const JobBoard::Offered first = board_.offer(quilt("quilt", 10));
  EXPECT_TRUE(first.is_news);
  EXPECT_EQ(first.engine, kFirst);
  EXPECT_FALSE(board_.offer(quilt("quilt", 20, 2)).is_news) << "one of it waits";
  EXPECT_EQ(begin(kFirst), "quilt");
  EXPECT_TRUE(board_.offer(quilt("quilt", 30, 3)).is_news);
}

TEST_F(JobBoardTest, returnsTheJobOfAnOlderStructure) {
  board_.offer(quilt("quilt", 10, 1));
  const JobBoard::Offered newer = board_.offer(quilt("quilt", 20, 2));
  ASSERT_TRUE(newer.replaced);
  EXPECT_EQ(newer.replaced->structure->serial, 1u);
}

TEST_F(JobBoardTest, takesATickOnlyWhileNoAtlasOfItsPictureIsOnItsWay) {
  const AtlasJob tick = quilt("quilt", 10);
  EXPECT_TRUE(board_.offerUnlessBusy(tick));
  EXPECT_FALSE(board_.offerUnlessBusy(tick)) << "it waits";
  begin(kFirst);
  EXPECT_FALSE(board_.offerUnlessBusy(tick)) << "it is being made";
  board_.finish("quilt");
  EXPECT_TRUE(board_.offerUnlessBusy(tick));
}

TEST_F(JobBoardTest, beginsWhatIsDueBeforeAllThatHasBegun) {
  const Claim begun{.deadline_ns = 100};
  board_.offer(quilt("late", 100));
  EXPECT_EQ(begin(kFirst, &begun), "");
  board_.offer(quilt("soon", 99));
  EXPECT_EQ(begin(kFirst, &begun), "soon");
  EXPECT_EQ(begin(kFirst, &begun), "");
}

TEST_F(JobBoardTest, beginsAnythingBesideAnAtlasThatHasHadMuchTime) {
  const Claim begun{.deadline_ns = 100};
  for (int i = 0; i < 10; ++i) shares_.begin(begun, kInOrder_ns);
  board_.offer(quilt("late", 1000));
  EXPECT_EQ(begin(kFirst, &begun), "late");
}

TEST_F(JobBoardTest, beginsEyesBesideAnAtlasThatIsDueBeforeThem) {
  const Claim begun{.deadline_ns = -100};
  board_.offer(eyes());
  EXPECT_EQ(begin(kFirst, &begun, false), "") << "those of somebody are being served";
  EXPECT_EQ(begin(kFirst, &begun), "eyes");
}

TEST_F(JobBoardTest, doesNotBeginEyesBesideEyesThatAreDueBeforeThem) {
  const Claim begun{.deadline_ns = -100, .is_tracked = true};
  board_.offer(eyes());
  EXPECT_EQ(begin(kFirst, &begun), "");
}

TEST_F(JobBoardTest, waitsForPosesThatAreAboutToCome) {
  board_.offer(eyes());
  const int64_t due_ns = clock_.nowNs() + kHeadset_ns;
  clock_.advance(7 * kMs_ns);
  EXPECT_EQ(begin(kFirst), "");
  EXPECT_EQ(board_.eyesWaitUntilNs(kFirst), due_ns + kAlikePoses_ns);
  board_.offer(quilt("quilt", 1000));
  EXPECT_EQ(begin(kFirst), "") << "to begin a quilt would take longer";
  clock_.advance(due_ns - clock_.nowNs());
  EXPECT_TRUE(board_.offer(eyes()).is_news) << "they have come";
  EXPECT_EQ(begin(kFirst), "eyes");
  EXPECT_EQ(board_.eyesWaitUntilNs(kFirst), std::nullopt);
}

TEST_F(JobBoardTest, letsOthersBeginWhileSomebodysEyesWaitForPoses) {
  AtlasJob job = eyes();
  job.payers = {Payer("10.0.0.1")};
  board_.offer(job);
  clock_.advance(7 * kMs_ns);
  AtlasJob other = quilt("quilt", 1000);
  other.payers = {Payer("10.0.0.2")};
  board_.offer(other);
  EXPECT_EQ(begin(kFirst), "quilt");
  EXPECT_EQ(begin(kFirst), "");
  EXPECT_TRUE(board_.eyesWaitUntilNs(kFirst));
}

TEST_F(JobBoardTest, letsEyesOfOnePayerNotPassAnother) {
  AtlasJob job = eyes();
  job.payers = {Payer("10.0.0.1")};
  board_.offer(job);
  shares_.begin(claimOf(job), kInOrder_ns);
  AtlasJob other = quilt("quilt", 1000);
  other.payers = {Payer("10.0.0.2")};
  board_.offer(other);
  EXPECT_EQ(begin(kFirst, nullptr, false), "quilt");
}

TEST_F(JobBoardTest, waitsNoLongerForPosesThatDoNotCome) {
  board_.offer(eyes());
  clock_.advance(7 * kMs_ns);
  EXPECT_EQ(begin(kFirst), "");
  clock_.advance(*board_.eyesWaitUntilNs(kFirst) - clock_.nowNs());
  EXPECT_EQ(begin(kFirst), "eyes");
}

TEST_F(JobBoardTest, keepsAPictureInTheLaneOfTheEngineItWasHandedTo) {
  board_.offer(quilt("quilt", 10));
  std::optional<AtlasJob> job = beginFirst();
  ASSERT_TRUE(job);
  EXPECT_EQ(begin(kSecond), "");
  board_.offer(quilt("quilt", 20, 2));  // while the first is being planned
  const auto replaced = board_.handOver(*std::move(job), kFirst, kSecond);
  ASSERT_TRUE(replaced) << "the newer one goes with it";
  EXPECT_EQ(replaced->structure->serial, 1u);
  EXPECT_EQ(begin(kFirst), "");
  EXPECT_EQ(begin(kSecond), "quilt");
  board_.finish("quilt");
  EXPECT_EQ(board_.offer(quilt("quilt", 30, 3)).engine, kSecond);
  begin(kSecond);
  board_.finish("quilt");
  board_.keepOnly({});
  EXPECT_EQ(board_.offer(quilt("quilt", 40, 4)).engine, kFirst) << "nobody watched it meanwhile";
}

TEST_F(JobBoardTest, beginsAJobThatWasPutBackOnceItIsFinished) {
  board_.offer(quilt("quilt", 10));
  std::optional<AtlasJob> job = beginFirst();
  ASSERT_TRUE(job);
  EXPECT_FALSE(board_.putBack(*std::move(job), kFirst));
  EXPECT_EQ(begin(kFirst), "") << "its kernels are being compiled";
  EXPECT_TRUE(board_.isBusy("quilt"));
  EXPECT_TRUE(board_.isWaiting("quilt"));
  board_.finish("quilt");
  EXPECT_EQ(begin(kFirst), "quilt");
}

TEST_F(JobBoardTest, beginsWhatGoesOnBeforeAllThatHasNotBegun) {
  board_.offer(quilt("quilt", 10));
  std::optional<AtlasJob> job = beginFirst();
  ASSERT_TRUE(job);
  board_.offer(quilt("sooner", 5));
  const Claim begun{.deadline_ns = 1};
  EXPECT_EQ(begin(kFirst, &begun), "");
  board_.resume(*std::move(job), kFirst);
  EXPECT_EQ(begin(kSecond), "") << "it is made by the engine that it waited for";
  EXPECT_EQ(begin(kFirst, &begun), "quilt");
  EXPECT_EQ(begin(kFirst, &begun), "") << "it goes on once";
  EXPECT_EQ(begin(kFirst), "sooner");
}

TEST_F(JobBoardTest, handsBackWhatHasNotGoneOn) {
  board_.offer(quilt("quilt", 10));
  std::optional<AtlasJob> job = beginFirst();
  ASSERT_TRUE(job);
  board_.resume(*std::move(job), kFirst);
  ASSERT_EQ(board_.clear().size(), 1u);
  EXPECT_EQ(begin(kFirst), "");
}

TEST_F(JobBoardTest, handsBackWhatHasNotBegunInAnyLane) {
  board_.offer(quilt("begun", 10));
  begin(kFirst);
  board_.offer(quilt("waiting", 20));
  ASSERT_EQ(board_.clear().size(), 1u);
  EXPECT_EQ(begin(kFirst), "");
}

}  // namespace
}  // namespace viewloom::job_board_test
