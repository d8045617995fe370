// SPDX-License-Identifier: Apache-2.0
#include "schedule/frame_ticket.h"

#include <gmock/gmock.h>

#include <vector>

namespace viewloom::frame_ticket_test {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;
using testing::SizeIs;

class FrameTicketTest : public testing::Test {
 protected:
  FrameTicketPtr makeTicket() {
    return std::make_shared<FrameTicket>(
        7, [this](const FrameReport& report) { reports_.push_back(report); });
  }

  std::vector<FrameReport> reports_;
};

TEST_F(FrameTicketTest, reportsOnceAndOnlyWhenTheLastHolderLetsGo) {
  FrameTicketPtr first = makeTicket();
  FrameTicketPtr second = first;
  first.reset();
  EXPECT_THAT(reports_, IsEmpty());
  second.reset();
  ASSERT_THAT(reports_, SizeIs(1));
  EXPECT_EQ(reports_[0].number, 7u);
}

TEST_F(FrameTicketTest, callsAFrameReplacedThatNeverBecameResident) {
  makeTicket().reset();
  EXPECT_EQ(reports_.at(0).outcome, FrameOutcome::kReplaced);
}

TEST_F(FrameTicketTest, callsAWatchedFrameReplacedWhenNoDisplayGotIt) {
  makeTicket()->noteBuilt({}, true);
  EXPECT_EQ(reports_.at(0).outcome, FrameOutcome::kReplaced);
}

TEST_F(FrameTicketTest, saysThatNobodyWatched) {
  makeTicket()->noteBuilt({.depth_step = 0.5}, false);
  EXPECT_EQ(reports_.at(0).outcome, FrameOutcome::kBuiltWithoutDisplay);
  EXPECT_EQ(reports_.at(0).stats.depth_step, 0.5);
}

TEST_F(FrameTicketTest, listsEveryDisplayThatGotTheFrame) {
  {
    const FrameTicketPtr ticket = makeTicket();
    ticket->noteBuilt({}, true);
    ticket->noteTraced({.display_id = 3});
    ticket->noteTraced({.display_id = 5});
  }
  EXPECT_EQ(reports_.at(0).outcome, FrameOutcome::kTraced);
  EXPECT_THAT(reports_.at(0).displays, ElementsAre(Field(&DisplayReport::display_id, 3u),
                                                   Field(&DisplayReport::display_id, 5u)));
}

TEST_F(FrameTicketTest, saysWhyAFrameWasRefused) {
  makeTicket()->noteRefused("too large");
  EXPECT_EQ(reports_.at(0).outcome, FrameOutcome::kRefused);
  EXPECT_EQ(reports_.at(0).reason, "too large");
}

TEST_F(FrameTicketTest, saysThatNothingWasMadeOfAFrame) {
  makeTicket()->noteUnchanged({.depth_step = 0.5});
  EXPECT_EQ(reports_.at(0).outcome, FrameOutcome::kUnchanged);
  EXPECT_EQ(reports_.at(0).stats.depth_step, 0.5);
}

}  // namespace
}  // namespace viewloom::frame_ticket_test
