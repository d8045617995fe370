// SPDX-License-Identifier: Apache-2.0
#include "pipeline/atlas_run.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "display/video_stack.h"

namespace viewloom::atlas_run_test {
namespace {

const VideoStack kStack = {.view_count = 3, .picture_count = 3, .cell_px = {64, 48}};

AtlasRun runOf(BandEncoding color, const std::vector<VideoRung>& rungs = {VideoRung::kFirst},
               const std::shared_ptr<AtlasChain>& chain = nullptr) {
  auto layout = std::make_shared<AtlasLayout>();
  layout->size_px = {64, 3 * 48};
  layout->tile_size_px = {64, 48};
  layout->image_count = 3;
  layout->stack = kStack;
  auto picture = std::make_shared<TraceJob>();
  picture->layout = std::move(layout);
  std::vector<ActiveDisplayPtr> displays;
  for (const VideoRung rung : rungs) {
    auto display = std::make_shared<ActiveDisplay>();
    display->encoding.color = color;
    display->encoding.rung = rung;
    display->chain = chain;
    displays.push_back(std::move(display));
  }
  return {AtlasJob{.picture_key = "views", .structure = std::make_shared<ResidentStructure>()},
          std::move(picture), Pose{}, std::move(displays)};
}

TEST(AtlasRun, holdsTheMemoryOfItsVideo) {
  MemoryBudget budget(100'000'000);
  {
    AtlasRun run = runOf(BandEncoding::kH264);
    EXPECT_TRUE(run.reserveVideo(budget).empty());
    EXPECT_EQ(budget.reservedBytes(MemoryUse::kAtlases), videoAtlasBytes(kStack));
    EXPECT_FALSE(run.isWaitedFor());
    run.releaseVideo();
    EXPECT_EQ(budget.reservedBytes(MemoryUse::kAtlases), 0U);
    EXPECT_TRUE(run.reserveVideo(budget).empty());
  }
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kAtlases), 0U) << "given up";
  AtlasRun stills = runOf(BandEncoding::kJpeg);
  EXPECT_TRUE(stills.reserveVideo(budget).empty());
  stills.noteOlder();
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kAtlases), 0U);
  EXPECT_FALSE(stills.isWaitedFor());
}

// Strips of the last picture come first then, in all that count them.
TEST(AtlasRun, isMadeInTheOrderOfItsChain) {
  const auto chain = std::make_shared<AtlasChain>();
  EXPECT_EQ(runOf(BandEncoding::kH264).strips.order(), PictureOrder::kForward);
  EXPECT_EQ(runOf(BandEncoding::kH264, {VideoRung::kFirst}, chain).strips.imageAt(0), 0U);
  chain->begin(1, 0, PictureOrder::kForward);
  const AtlasStrips strips = runOf(BandEncoding::kH264, {VideoRung::kFirst}, chain).strips;
  ASSERT_EQ(strips.count() % 3, 0U);
  EXPECT_EQ(strips.placeOf(0), 0U);
  EXPECT_EQ(strips.imageAt(0), 2U);
  EXPECT_EQ(strips.rowsOf(0).first_row, 2U * 48);
  EXPECT_EQ(strips.rowInImage(0), 0U);
  const uint32_t last = strips.count() - 1;
  EXPECT_EQ(strips.imageAt(strips.placeOf(last)), 0U);
  EXPECT_EQ(strips.rowsOf(last).first_row + strips.rowsOf(last).row_count, 48U);
}

// A device is faster than the coding of its pictures, which would pile up.
TEST(AtlasRun, isWaitedForBehindAnotherOfItsVideo) {
  MemoryBudget budget(100'000'000);
  AtlasRun run = runOf(BandEncoding::kH264);
  EXPECT_TRUE(run.reserveVideo(budget).empty());
  EXPECT_FALSE(run.isWaitedFor());
  run.noteOlder();
  EXPECT_TRUE(run.isWaitedFor());
}

TEST(AtlasRun, isWaitedForWhereNoOtherFits) {
  MemoryBudget budget(videoAtlasBytes(kStack) * 3 / 2);
  AtlasRun run = runOf(BandEncoding::kH264);
  EXPECT_TRUE(run.reserveVideo(budget).empty());
  EXPECT_TRUE(run.isWaitedFor());
  AtlasRun refused = runOf(BandEncoding::kH264);
  EXPECT_THROW(static_cast<void>(refused.reserveVideo(budget)), EngineOutOfMemory);
}

// A second rung is a favour: those on the first are not to pay for it.
TEST(AtlasRun, givesUpASecondRungWhereMemoryIsShort) {
  MemoryBudget budget(videoAtlasBytes(kStack) * 3 / 2);
  AtlasRun both = runOf(BandEncoding::kH264, {VideoRung::kFirst, VideoRung::kSecond});
  const std::vector<ActiveDisplayPtr> ended = both.reserveVideo(budget);
  ASSERT_EQ(ended.size(), 1U);
  EXPECT_EQ(ended.front(), both.outputs.back().display);
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kAtlases), 0U);
  AtlasRun first = runOf(BandEncoding::kH264);
  EXPECT_TRUE(first.reserveVideo(budget).empty());
  AtlasRun second = runOf(BandEncoding::kH264, {VideoRung::kSecond});
  EXPECT_EQ(second.reserveVideo(budget).size(), 1U) << "it ends no display of the first";
}

}  // namespace
}  // namespace viewloom::atlas_run_test
