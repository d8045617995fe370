// SPDX-License-Identifier: Apache-2.0
#include "schedule/retime_schedule.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace viewloom {

// Only its presence counts.
class StreamRetimer {};

namespace retime_schedule_test {
namespace {

std::shared_ptr<ResidentStructure> moving(const std::string& stream = "scene") {
  auto structure = std::make_shared<ResidentStructure>();
  structure->stream = stream;
  structure->retimer = std::make_shared<StreamRetimer>();
  return structure;
}

std::shared_ptr<ResidentStructure> standing() {
  auto structure = moving();
  structure->retimer = nullptr;
  return structure;
}

AtlasJob tickOf(const std::string& picture_key, const ResidentPtr& structure, int64_t carried_ns) {
  AtlasJob job{.picture_key = picture_key, .structure = structure};
  job.tick = OutputTick{.shown = {.carried_ns = carried_ns}, .frames_apart_ns = 100};
  return job;
}

TEST(RetimeDates, areOfTheTimeThatTheTickShows) {
  const RetimeDates dates = retimeDatesOf(tickOf("quilt", moving(), 30));
  EXPECT_EQ(dates.newest_ns, 30);
  EXPECT_EQ(dates.before_ns, std::nullopt);
}

TEST(RetimeDates, meetBetweenTwoFrames) {
  AtlasJob job = tickOf("quilt", moving(), -40);
  job.before = moving();
  const RetimeDates dates = retimeDatesOf(job);
  EXPECT_EQ(dates.newest_ns, -40) << "back from the newest frame";
  EXPECT_EQ(dates.before_ns, 60) << "on from the one before, which is 100 older";
}

TEST(RetimeDates, leaveAFrameBeforeThatStands) {
  AtlasJob job = tickOf("quilt", moving(), -40);
  job.before = standing();
  EXPECT_EQ(retimeDatesOf(job).before_ns, std::nullopt);
}

TEST(RetimeDates, areOfFramesInWhichSomethingHasGoneOn) {
  EXPECT_TRUE(isRetimed(tickOf("quilt", moving(), 30)));
  EXPECT_FALSE(isRetimed(tickOf("quilt", moving(), 0))) << "the frame as it came";
  EXPECT_FALSE(isRetimed(tickOf("quilt", standing(), 30)));
  AtlasJob both = tickOf("quilt", moving(), 0);
  both.before = moving();
  EXPECT_TRUE(isRetimed(both)) << "the frame before has to go on to this one";
}

// Without threads: a test takes and finishes ticks when it likes.
class RetimeScheduleTest : public testing::Test {
 protected:
  RetimeSchedule::Offered offer(AtlasJob job) { return schedule_.offer(std::move(job), display_); }
  // "quilt 3"; "" where all have to wait.
  std::string takeName() {
    const auto tick = schedule_.take();
    if (!tick) return "";
    return tick->job.picture_key + " " + std::to_string(tick->job.tick->shown.carried_ns);
  }
  void finish(const std::string& stream = "scene") { EXPECT_TRUE(schedule_.finish(stream)); }

  const ActiveDisplayPtr display_ = std::make_shared<ActiveDisplay>();
  const ResidentPtr structure_ = moving();
  RetimeSchedule schedule_;
};

TEST_F(RetimeScheduleTest, servesTicksOfAStreamOneAfterTheOther) {
  offer(tickOf("quilt", structure_, 1));
  offer(tickOf("stereo", structure_, 1));
  EXPECT_EQ(takeName(), "quilt 1");
  EXPECT_EQ(takeName(), "");
  EXPECT_TRUE(schedule_.isBusy(tickOf("quilt", structure_, 2)));
  finish();
  EXPECT_FALSE(schedule_.isBusy(tickOf("quilt", structure_, 2)));
  EXPECT_EQ(takeName(), "stereo 1");
}

TEST_F(RetimeScheduleTest, servesStreamsAtOnceAndCountsThem) {
  EXPECT_EQ(schedule_.streamCount(), 0u);
  offer(tickOf("quilt", moving("a"), 1));
  offer(tickOf("quilt", moving("b"), 2));
  EXPECT_EQ(schedule_.streamCount(), 2u);
  EXPECT_EQ(takeName(), "quilt 1");
  EXPECT_EQ(takeName(), "quilt 2");
  finish("b");
  EXPECT_EQ(schedule_.streamCount(), 1u);
}

TEST_F(RetimeScheduleTest, keepsTheNewestTickOfAPictureInItsPlace) {
  offer(tickOf("quilt", structure_, 1));
  offer(tickOf("stereo", structure_, 1));
  const RetimeSchedule::Offered newer = offer(tickOf("quilt", structure_, 2));
  EXPECT_TRUE(newer.is_taken);
  ASSERT_TRUE(newer.replaced);
  EXPECT_EQ(newer.replaced->job.tick->shown.carried_ns, 1);
  EXPECT_EQ(takeName(), "quilt 2");
}

TEST_F(RetimeScheduleTest, refusesATickOfAPictureThatIsBeingServed) {
  offer(tickOf("quilt", structure_, 1));
  takeName();
  EXPECT_FALSE(offer(tickOf("quilt", structure_, 2)).is_taken);
  finish();
  EXPECT_EQ(takeName(), "");
}

// Else displays of one stream would never share what is made.
TEST_F(RetimeScheduleTest, keepsATickThatShowsWhatIsBeingMade) {
  offer(tickOf("quilt", structure_, 1));
  takeName();
  offer(tickOf("stereo", structure_, 1));
  EXPECT_FALSE(offer(tickOf("stereo", structure_, 2)).is_taken);
  finish();
  EXPECT_EQ(takeName(), "stereo 1");
}

TEST_F(RetimeScheduleTest, handsTheTicketOfAReplacedTickOnUnlessTheNewerHasOne) {
  AtlasJob first = tickOf("quilt", structure_, 1);
  first.ticket = std::make_shared<FrameTicket>(1, nullptr);
  const FrameTicketPtr ticket = first.ticket;
  offer(std::move(first));
  EXPECT_EQ(offer(tickOf("quilt", structure_, 2)).replaced->job.ticket, nullptr);
  AtlasJob newer = tickOf("quilt", structure_, 3);
  newer.ticket = std::make_shared<FrameTicket>(2, nullptr);
  EXPECT_EQ(offer(std::move(newer)).replaced->job.ticket, ticket);
}

TEST_F(RetimeScheduleTest, leavesARefusedJobWhereItIs) {
  offer(tickOf("quilt", structure_, 1));
  takeName();
  AtlasJob refused = tickOf("quilt", structure_, 2);
  EXPECT_FALSE(schedule_.offer(std::move(refused), display_).is_taken);
  EXPECT_EQ(refused.structure, structure_);
}

}  // namespace
}  // namespace retime_schedule_test
}  // namespace viewloom
