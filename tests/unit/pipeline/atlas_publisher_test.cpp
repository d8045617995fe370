// SPDX-License-Identifier: Apache-2.0
// Atlases that are given up while others are handed out.
#include "pipeline/atlas_publisher.h"

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace viewloom::atlas_publisher_test {
namespace {

class AtlasPublisherTest : public testing::Test {
 protected:
  // A run of a display that nobody watches; nothing of it is left to be packed.
  static AtlasRunPtr runOf(const std::string& picture_key, FrameTicketPtr ticket) {
    auto layout = std::make_shared<AtlasLayout>();
    layout->size_px = layout->tile_size_px = {64, 64};
    auto picture = std::make_shared<TraceJob>();
    picture->layout = std::move(layout);
    auto run = std::make_shared<AtlasRun>(
        AtlasJob{.picture_key = picture_key,
                 .structure = std::make_shared<ResidentStructure>(),
                 .ticket = std::move(ticket)},
        std::move(picture), Pose{},
        std::vector<ActiveDisplayPtr>{std::make_shared<ActiveDisplay>()});
    run->outputs.front().atlas = std::make_shared<GrowingAtlas>(EncodedAtlas{});
    return run;
  }

  const Engines engines_;
  ManualClock clock_;
  Metrics metrics_;
  Broadcaster broadcaster_{BroadcasterLimits{}};
  StreamDirectory directory_{clock_, 4};
  const PipelineLinks links_{.engines = engines_,
                             .clock = clock_,
                             .metrics = metrics_,
                             .broadcaster = broadcaster_,
                             .directory = directory_,
                             .on_failure = [](const std::exception&) {}};
  AtlasPublisher publisher_{links_, [](const AtlasRun&) {}};
};

// The report is sent while the atlas is handed out.
TEST_F(AtlasPublisherTest, saysThatItCouldNotGiveUp) {
  const AtlasRunPtr unwatched = runOf("unwatched", nullptr);
  std::optional<bool> is_done;
  const AtlasRunPtr handed_out = runOf(
      "handed out", std::make_shared<FrameTicket>(1, [&](const FrameReport&) {
        is_done =
            std::async(std::launch::async, [&] { return publisher_.giveUpUnwatched(); }).get();
      }));
  publisher_.begin(unwatched);
  publisher_.begin(handed_out);
  publisher_.complete(*handed_out);
  EXPECT_EQ(is_done, false);
  EXPECT_FALSE(unwatched->isGivenUp());
  EXPECT_TRUE(publisher_.giveUpUnwatched());
  EXPECT_TRUE(unwatched->isGivenUp());
}

TEST_F(AtlasPublisherTest, knowsWhatIsOnItsWay) {
  const AtlasRunPtr run = runOf("picture", nullptr);
  EXPECT_FALSE(publisher_.isOnItsWay("picture"));
  publisher_.begin(run);
  EXPECT_TRUE(publisher_.isOnItsWay("picture"));
  EXPECT_FALSE(publisher_.isOnItsWay("another"));
  publisher_.complete(*run);
  EXPECT_FALSE(publisher_.isOnItsWay("picture"));
}

}  // namespace
}  // namespace viewloom::atlas_publisher_test
