// SPDX-License-Identifier: Apache-2.0
// Which part encode threads take next.
#include "pipeline/encode_queue.h"

#include <gtest/gtest.h>

#include <string>

namespace viewloom::encode_queue_test {
namespace {

// An atlas of several strips.
AtlasRunPtr runOf(const std::string& name, int64_t deadline_ns, bool is_tracked = false) {
  auto layout = std::make_shared<AtlasLayout>();
  layout->size_px = layout->tile_size_px = {64, 512};
  auto picture = std::make_shared<TraceJob>();
  picture->layout = std::move(layout);
  auto display = std::make_shared<ActiveDisplay>();
  display->picture_key = name;
  if (is_tracked) display->eyes = std::make_shared<EyeTrack>();
  return std::make_shared<AtlasRun>(AtlasJob{.picture_key = name, .deadline_ns = deadline_ns},
                                    std::move(picture), Pose{},
                                    std::vector<ActiveDisplayPtr>{std::move(display)});
}

struct NoWork final : StripWork {
  using StripWork::StripWork;
  void makePiece(uint32_t) override {}
  RayCounts counts() const override { return {}; }
  StripPlanes planes(uint32_t) const override { return {}; }
};

class EncodeQueueTest : public ::testing::Test {
 protected:
  void push(const AtlasRunPtr& run, uint32_t strip_count, uint32_t piece_count = 0) {
    queue_.push(std::make_shared<StripBatch>(
        run, std::make_unique<NoWork>(
                 StripWorkShape{.strip_count = strip_count, .piece_count = piece_count})));
  }
  // "soon piece 0", "soon strip 1"
  std::string popName() {
    std::optional<EncodeTask> task = queue_.pop();
    if (!task) return "";
    popped_ = task->batch;
    return popped_->run->job.picture_key + (task->is_strip ? " strip " : " piece ") +
           std::to_string(task->index);
  }

  EncodeQueue queue_;
  StripBatchPtr popped_;
};

TEST_F(EncodeQueueTest, whatIsDueSoonerGoesFirst) {
  push(runOf("late", 200), 1);
  push(runOf("soon", 100), 1);
  EXPECT_EQ(popName(), "soon strip 0");
  EXPECT_EQ(popName(), "late strip 0");
}

TEST_F(EncodeQueueTest, batchesOfOneAtlasKeepTheirOrder) {
  const AtlasRunPtr run = runOf("quilt", 100);
  push(run, 1);
  push(run, 2);
  EXPECT_EQ(popName(), "quilt strip 0");
  EXPECT_EQ(popName(), "quilt strip 0");
  EXPECT_EQ(popName(), "quilt strip 1");
}

TEST_F(EncodeQueueTest, stripsWaitUntilAllPiecesAreMade) {
  push(runOf("quilt", 100), 2, 2);
  EXPECT_EQ(popName(), "quilt piece 0");
  EXPECT_EQ(popName(), "quilt piece 1");
  push(runOf("late", 200), 1);
  EXPECT_EQ(popName(), "late strip 0") << "the quilt's pieces are being made";
  EXPECT_NE(popped_, nullptr);
}

TEST_F(EncodeQueueTest, stripsFollowTheLastPiece) {
  push(runOf("quilt", 100), 2, 2);
  popName();
  popName();
  queue_.noteMade(*popped_);
  queue_.noteMade(*popped_);
  EXPECT_EQ(popName(), "quilt strip 0");
  EXPECT_EQ(popName(), "quilt strip 1");
}

TEST_F(EncodeQueueTest, whatIsDueSoonerPassesBetweenPieces) {
  push(runOf("lens", 200), 1, 3);
  EXPECT_EQ(popName(), "lens piece 0");
  push(runOf("soon", 100), 1);
  push(runOf("late", 300), 1);
  EXPECT_EQ(popName(), "soon strip 0");
  EXPECT_EQ(popName(), "lens piece 1");
  EXPECT_EQ(popName(), "lens piece 2");
  EXPECT_EQ(popName(), "late strip 0");
}

TEST_F(EncodeQueueTest, trackedDisplaysGoFirstButLeaveOthersTheirTurn) {
  push(runOf("quilt", 100), 1, 3);
  push(runOf("eyes", 900, true), 1, 3);
  EXPECT_EQ(popName(), "eyes piece 0");
  queue_.noteServed(*popped_->run, 3000);
  EXPECT_EQ(popName(), "quilt piece 0") << "a part for every three of eyes";
  queue_.noteServed(*popped_->run, 1000);
  EXPECT_EQ(popName(), "eyes piece 1");
}

TEST_F(EncodeQueueTest, anAtlasThatTakesLongLetsOthersGoFirstAndHasHalfOfTheTime) {
  push(runOf("lens", 100), 1, 3);
  EXPECT_EQ(popName(), "lens piece 0");
  popped_->run->at_work.had = kTurn_ns;
  push(runOf("quilt", 200), 1, 3);
  EXPECT_EQ(popName(), "quilt piece 0");
  queue_.noteServed(*popped_->run, 1000);
  EXPECT_EQ(popName(), "lens piece 1") << "its turn, as long as the quilt's";
  queue_.noteServed(*popped_->run, 1000);
  EXPECT_EQ(popName(), "quilt piece 1");
}

TEST_F(EncodeQueueTest, whatHasBegunIsHandedOutAfterTheQueueIsClosed) {
  push(runOf("lens", 200), 1, 1);
  EXPECT_EQ(popName(), "lens piece 0");
  queue_.close();
  queue_.noteMade(*popped_);
  EXPECT_EQ(popName(), "lens strip 0");
  EXPECT_FALSE(queue_.pop().has_value());
}

}  // namespace
}  // namespace viewloom::encode_queue_test
