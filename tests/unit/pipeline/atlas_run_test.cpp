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

AtlasRun runOf(BandEncoding color) {
  auto layout = std::make_shared<AtlasLayout>();
  layout->size_px = {64, 3 * 48};
  layout->tile_size_px = {64, 48};
  layout->image_count = 3;
  layout->stack = kStack;
  auto picture = std::make_shared<TraceJob>();
  picture->layout = std::move(layout);
  auto display = std::make_shared<ActiveDisplay>();
  display->encoding.color = color;
  return {AtlasJob{.picture_key = "views", .structure = std::make_shared<ResidentStructure>()},
          std::move(picture), Pose{}, std::vector<ActiveDisplayPtr>{std::move(display)}};
}

TEST(AtlasRun, holdsTheMemoryOfItsVideo) {
  MemoryBudget budget(100'000'000);
  {
    AtlasRun run = runOf(BandEncoding::kH264);
    run.reserveVideo(budget);
    EXPECT_EQ(budget.reservedBytes(MemoryUse::kAtlases), videoAtlasBytes(kStack));
    EXPECT_FALSE(run.isWaitedFor());
    run.releaseVideo();
    EXPECT_EQ(budget.reservedBytes(MemoryUse::kAtlases), 0U);
    run.reserveVideo(budget);
  }
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kAtlases), 0U) << "given up";
  AtlasRun stills = runOf(BandEncoding::kJpeg);
  stills.reserveVideo(budget);
  stills.noteOlder();
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kAtlases), 0U);
  EXPECT_FALSE(stills.isWaitedFor());
}

// A device is faster than the coding of its pictures, which would pile up.
TEST(AtlasRun, isWaitedForBehindAnotherOfItsVideo) {
  MemoryBudget budget(100'000'000);
  AtlasRun run = runOf(BandEncoding::kH264);
  run.reserveVideo(budget);
  EXPECT_FALSE(run.isWaitedFor());
  run.noteOlder();
  EXPECT_TRUE(run.isWaitedFor());
}

TEST(AtlasRun, isWaitedForWhereNoOtherFits) {
  MemoryBudget budget(videoAtlasBytes(kStack) * 3 / 2);
  AtlasRun run = runOf(BandEncoding::kH264);
  run.reserveVideo(budget);
  EXPECT_TRUE(run.isWaitedFor());
  AtlasRun refused = runOf(BandEncoding::kH264);
  EXPECT_THROW(refused.reserveVideo(budget), EngineOutOfMemory);
}

}  // namespace
}  // namespace viewloom::atlas_run_test
