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

  static AtlasRunPtr videoOf(const std::string& picture_key) {
    auto layout = std::make_shared<AtlasLayout>();
    layout->size_px = layout->tile_size_px = {64, 48};
    layout->stack = VideoStack{.view_count = 1, .picture_count = 1, .cell_px = {64, 48}};
    auto picture = std::make_shared<TraceJob>();
    picture->layout = std::move(layout);
    auto display = std::make_shared<ActiveDisplay>();
    display->encoding.color = BandEncoding::kH264;
    auto run = std::make_shared<AtlasRun>(
        AtlasJob{.picture_key = picture_key, .structure = std::make_shared<ResidentStructure>()},
        std::move(picture), Pose{}, std::vector<ActiveDisplayPtr>{std::move(display)});
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

TEST_F(AtlasPublisherTest, tellsAVideoThatAnOlderOneIsOnItsWay) {
  MemoryBudget budget(100'000'000);
  const auto begin = [&](const std::string& picture_key) {
    AtlasRunPtr run = videoOf(picture_key);
    EXPECT_TRUE(run->reserveVideo(budget).empty());
    publisher_.begin(run);
    return run;
  };
  const AtlasRunPtr first = begin("picture");
  EXPECT_FALSE(first->isWaitedFor());
  const AtlasRunPtr second = begin("picture");
  EXPECT_TRUE(second->isWaitedFor());
  EXPECT_FALSE(begin("another")->isWaitedFor());
  publisher_.complete(*first);
  publisher_.complete(*second);
  EXPECT_FALSE(begin("picture")->isWaitedFor());
}

}  // namespace
}  // namespace viewloom::atlas_publisher_test
