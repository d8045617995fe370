// SPDX-License-Identifier: Apache-2.0
#include "schedule/tick_schedule.h"

#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <vector>

#include "base/clock.h"

namespace viewloom::tick_schedule_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr int64_t kMs_ns = 1'000'000;
constexpr int64_t kTick_ns = 20 * kMs_ns;
constexpr double kRate_hz = 50;

ActiveDisplayPtr displayOf(const std::string& picture_key,
                           const std::optional<TemporalSpec>& temporal) {
  auto display = std::make_shared<ActiveDisplay>();
  display->stream = "scene";
  display->picture_key = picture_key;
  const QuiltSpec quilt{.columns = 2, .rows = 2, .size_px = {64, 64}, .view_cone_rad = 0.5};
  display->spec = *completeDisplaySpec({.kind = quilt, .temporal = temporal});
  return display;
}

ActiveDisplayPtr ticking(const std::string& picture_key, double rate_hz = kRate_hz) {
  return displayOf(picture_key, TemporalSpec{.output_rate_hz = rate_hz});
}

ResidentPtr structureOf(uint64_t serial) {
  auto structure = std::make_shared<ResidentStructure>();
  structure->stream = "scene";
  structure->serial = serial;
  structure->sources.resize(1);
  return structure;
}

// Displays of one stream, and a clock that is turned by hand.
class TickScheduleTest : public testing::Test {
 protected:
  bool note(const std::vector<ActiveDisplayPtr>& displays, const StreamInstant& newest,
            const FrameTicketPtr& ticket = nullptr) {
    return schedule_.note("scene", displays, newest, ticket, clock_.nowNs()).is_news;
  }
  bool note(const std::vector<ActiveDisplayPtr>& displays) { return note(displays, newest_); }
  std::vector<TickSchedule::DueTick> takeDue() { return schedule_.takeDue(clock_.nowNs()); }
  // The only one.
  TickSchedule::DueTick takeOne() {
    std::vector<TickSchedule::DueTick> due = takeDue();
    EXPECT_THAT(due, SizeIs(1));
    return due.at(0);
  }
  FrameTicketPtr ticket(uint64_t frame_number) {
    return std::make_shared<FrameTicket>(
        frame_number, [this](const FrameReport& report) { reported_.push_back(report.number); });
  }

  ManualClock clock_;
  const int64_t start_ns_ = clock_.nowNs();
  const StreamInstant newest_{.structure = structureOf(1), .motion = {}};
  std::vector<uint64_t> reported_;
  TickSchedule schedule_;
};

TEST_F(TickScheduleTest, hasNothingDueWithoutDisplaysThatTick) {
  EXPECT_FALSE(note({displayOf("quilt", std::nullopt)}));
  EXPECT_EQ(schedule_.soonestNs(), std::nullopt);
  EXPECT_THAT(takeDue(), IsEmpty());
}

TEST_F(TickScheduleTest, beginsWhenAPictureIsFirstSeenAndTicksAtItsRate) {
  EXPECT_TRUE(note({ticking("quilt")}));
  for (int tick = 0; tick < 5; ++tick) {
    EXPECT_EQ(schedule_.soonestNs(), start_ns_ + tick * kTick_ns);
    const TickSchedule::DueTick due = takeOne();
    EXPECT_EQ(due.job.picture_key, "quilt");
    EXPECT_EQ(due.job.structure, newest_.structure);
    EXPECT_EQ(due.job.tick->due_ns, start_ns_ + tick * kTick_ns);
    EXPECT_EQ(due.missed_count, 0u);
    clock_.advance(kTick_ns - 1);
    EXPECT_THAT(takeDue(), IsEmpty()) << "a nanosecond too soon";
    clock_.advance(1);
  }
}

TEST_F(TickScheduleTest, keepsTheDatesOfTicksAfterOneThatIsTakenLate) {
  note({ticking("quilt")});
  takeOne();
  clock_.advance(kTick_ns + kTick_ns / 2);
  EXPECT_EQ(takeOne().job.tick->due_ns, start_ns_ + kTick_ns);
  EXPECT_EQ(schedule_.soonestNs(), start_ns_ + 2 * kTick_ns);
}

TEST_F(TickScheduleTest, skipsAllButTheNewestTickAndCountsTheOthers) {
  note({ticking("quilt")});
  takeOne();
  clock_.advance(5 * kTick_ns + 1);
  const TickSchedule::DueTick due = takeOne();
  EXPECT_EQ(due.job.tick->due_ns, start_ns_ + 5 * kTick_ns);
  EXPECT_EQ(due.missed_count, 4u);
  EXPECT_THAT(takeDue(), IsEmpty());
}

TEST_F(TickScheduleTest, ticksEachPictureAtARateOfItsOwn) {
  note({ticking("fast", 100), ticking("slow", 40)});
  EXPECT_THAT(takeDue(), SizeIs(2));
  std::vector<std::string> taken;
  for (const int64_t due_ms : {10, 20, 25, 30, 40}) {
    EXPECT_EQ(schedule_.soonestNs(), start_ns_ + due_ms * kMs_ns);
    clock_.advance(*schedule_.soonestNs() - clock_.nowNs());
    taken.push_back(takeOne().job.picture_key);
  }
  EXPECT_THAT(taken, ElementsAre("fast", "fast", "slow", "fast", "fast"));
}

TEST_F(TickScheduleTest, ticksOnceForDisplaysThatShareAPicture) {
  note({ticking("quilt"), ticking("quilt")});
  takeOne();
}

TEST_F(TickScheduleTest, keepsTheDatesOfAPictureWhenFramesAndDisplaysCome) {
  note({ticking("quilt")});
  takeOne();
  clock_.advance(kTick_ns / 4);
  note({ticking("quilt"), ticking("stereo")}, {.structure = structureOf(2), .motion = {}});
  EXPECT_EQ(takeOne().job.picture_key, "stereo") << "a new picture is due at once";
  clock_.advance(3 * kTick_ns / 4);
  const TickSchedule::DueTick due = takeOne();
  EXPECT_EQ(due.job.picture_key, "quilt");
  EXPECT_EQ(due.job.structure->serial, 2u);
}

TEST_F(TickScheduleTest, showsWhereTheCameraIsWhenTheTickIsDueHoweverLateItIsTaken) {
  StreamInstant moving = newest_;
  moving.motion = {.camera = {.velocity_mps = {1, 0, 0}},
                   .captured_ns = 0,
                   .least_delay_ns = start_ns_,
                   .interval_ns = 100 * kMs_ns,
                   .things_move = true};
  note({ticking("quilt")}, moving);
  takeOne();
  clock_.advance(kTick_ns + kTick_ns / 2);
  const OutputTick tick = *takeOne().job.tick;
  EXPECT_EQ(tick.shown.time_ns, kTick_ns);
  EXPECT_EQ(tick.shown.carried_ns, kTick_ns);
  EXPECT_NEAR(tick.shown.source_pose.position_m.x, 0.02, 1e-9);
  EXPECT_EQ(tick.frames_apart_ns, 100 * kMs_ns);
}

TEST_F(TickScheduleTest, asksTheStructureBeforeOnlyForDisplaysThatInterpolate) {
  StreamInstant newest = newest_;
  newest.before = structureOf(0);
  const auto between = displayOf(
      "between", TemporalSpec{.output_rate_hz = kRate_hz, .mode = TemporalMode::kInterpolate});
  note({between, ticking("predicted")}, newest);
  const std::vector<TickSchedule::DueTick> due = takeDue();
  ASSERT_THAT(due, SizeIs(2));
  EXPECT_EQ(due[0].job.before, newest.before);
  EXPECT_EQ(due[1].job.before, nullptr);
}

TEST_F(TickScheduleTest, ignoresAStructureOlderThanTheOneItKnows) {
  note({ticking("quilt")}, {.structure = structureOf(5), .motion = {}});
  EXPECT_FALSE(note({ticking("quilt")}, {.structure = structureOf(4), .motion = {}}, ticket(4)));
  EXPECT_THAT(reported_, ElementsAre(4));
  EXPECT_EQ(takeOne().job.structure->serial, 5u);
}

TEST_F(TickScheduleTest, sendsATicketWithTheNextTickOfEachPictureOnce) {
  note({ticking("quilt"), ticking("stereo")}, newest_, ticket(1));
  for (TickSchedule::DueTick& due : takeDue()) EXPECT_NE(due.job.ticket, nullptr);
  EXPECT_THAT(reported_, ElementsAre(1));
  clock_.advance(kTick_ns);
  for (TickSchedule::DueTick& due : takeDue()) EXPECT_EQ(due.job.ticket, nullptr);
}

TEST_F(TickScheduleTest, letsGoOfATicketThatANewerReplaces) {
  note({ticking("quilt")}, newest_, ticket(1));
  note({ticking("quilt")}, {.structure = structureOf(2), .motion = {}}, ticket(2));
  EXPECT_THAT(reported_, ElementsAre(1));
}

TEST_F(TickScheduleTest, keepsTheTicketOfATickOfWhichNoAtlasComes) {
  note({ticking("quilt")}, newest_, ticket(1));
  TickSchedule::DueTick skipped = takeOne();
  schedule_.giveBack(skipped.job);
  EXPECT_EQ(skipped.job.ticket, nullptr);
  EXPECT_THAT(reported_, IsEmpty());
  clock_.advance(kTick_ns);
  EXPECT_NE(takeOne().job.ticket, nullptr);
}

TEST_F(TickScheduleTest, leavesATicketThatIsGivenBackAfterANewerFrame) {
  note({ticking("quilt")}, newest_, ticket(1));
  TickSchedule::DueTick skipped = takeOne();
  note({ticking("quilt")}, {.structure = structureOf(2), .motion = {}}, ticket(2));
  schedule_.giveBack(skipped.job);
  EXPECT_NE(skipped.job.ticket, nullptr);
}

TEST_F(TickScheduleTest, forgetsPicturesThatNobodyWatches) {
  note({ticking("quilt"), ticking("stereo")}, newest_, ticket(1));
  takeDue();
  note({ticking("quilt"), ticking("stereo")}, newest_, ticket(2));
  EXPECT_TRUE(note({ticking("stereo")}));
  clock_.advance(kTick_ns);
  EXPECT_EQ(takeOne().job.picture_key, "stereo");
  EXPECT_FALSE(note({}));
  EXPECT_EQ(schedule_.soonestNs(), std::nullopt);
}

}  // namespace
}  // namespace viewloom::tick_schedule_test
