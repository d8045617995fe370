// SPDX-License-Identifier: Apache-2.0
// Which part encode threads take next.
#include "pipeline/encode_queue.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace viewloom::encode_queue_test {
namespace {

// An atlas of several strips.
AtlasRunPtr runOf(const std::string& name, int64_t deadline_ns, bool is_tracked = false,
                  SizePx size_px = {64, 512}, const EncodingSpec& encoding = {}) {
  auto layout = std::make_shared<AtlasLayout>();
  layout->size_px = layout->tile_size_px = size_px;
  auto picture = std::make_shared<TraceJob>();
  picture->layout = std::move(layout);
  auto display = std::make_shared<ActiveDisplay>();
  display->picture_key = name;
  display->encoding = encoding;
  if (is_tracked) display->eyes = std::make_shared<EyeTrack>();
  return std::make_shared<AtlasRun>(AtlasJob{.picture_key = name, .deadline_ns = deadline_ns},
                                    std::move(picture), Pose{},
                                    std::vector<ActiveDisplayPtr>{std::move(display)});
}

struct NoWork final : StripWork {
  using StripWork::StripWork;
  void makePiece(uint32_t) override {}
  void notePiece(int64_t) override {}
  RayCounts counts() const override { return {}; }
  StripPlanes planes(uint32_t) const override { return {}; }
};

AtlasRunPtr paidBy(const char* address, AtlasRunPtr run) {
  run->claim.payers = {Payer(address)};
  return run;
}

class EncodeQueueTest : public ::testing::Test {
 protected:
  void push(const AtlasRunPtr& run, const StripWorkShape& shape) {
    queue_.push(std::make_shared<StripBatch>(run, std::make_unique<NoWork>(shape)));
  }
  void push(const AtlasRunPtr& run, uint32_t strip_count, uint32_t piece_count = 0) {
    push(run, {.strip_count = strip_count, .piece_count = piece_count, .piece_ns = 1000});
  }
  // Says that the task that was popped last is done.
  void serve(int64_t duration_ns) { queue_.noteServed(*task_, duration_ns); }
  // "soon piece 0", "soon strip 1"
  std::string popName() {
    task_ = queue_.pop();
    if (!task_) return "";
    popped_ = task_->batch;
    return popped_->run->job.picture_key + (task_->is_strip ? " strip " : " piece ") +
           std::to_string(task_->index);
  }

  FairShares shares_;
  EncodeQueue queue_{shares_};
  std::optional<EncodeTask> task_;
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

TEST_F(EncodeQueueTest, whatOthersWaitForGoesBeforeTheRestOfItsAtlas) {
  const AtlasRunPtr run = runOf("video", 100);
  push(run, 2, 1);
  popName();
  queue_.noteMade(*popped_);
  EXPECT_EQ(popName(), "video strip 0");
  // The coding of a picture packs no strips.
  queue_.pushFirst(std::make_shared<StripBatch>(
      run, std::make_unique<NoWork>(StripWorkShape{.strip_count = 0, .piece_count = 1})));
  EXPECT_EQ(popName(), "video piece 0");
  queue_.noteMade(*popped_);
  EXPECT_EQ(popName(), "video strip 1");
}

TEST_F(EncodeQueueTest, whatOthersWaitForIsDoneOnceTheQueueIsClosed) {
  queue_.close();
  queue_.pushFirst(std::make_shared<StripBatch>(
      runOf("video", 100),
      std::make_unique<NoWork>(StripWorkShape{.strip_count = 0, .piece_count = 1})));
  EXPECT_EQ(popName(), "video piece 0");
  EXPECT_EQ(popName(), "");
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
  serve(3000);
  EXPECT_EQ(popName(), "quilt piece 0") << "a part for every three of eyes";
  serve(1000);
  EXPECT_EQ(popName(), "eyes piece 1");
}

TEST_F(EncodeQueueTest, anAtlasThatTakesLongLetsOthersGoFirst) {
  push(runOf("lens", 100), 1, 9);
  EXPECT_EQ(popName(), "lens piece 0");
  serve(10 * kInOrder_ns);
  push(runOf("quilt", 200), 1, 3);
  shares_.enter(claimOf(AtlasJob{.picture_key = "quilt"}));
  EXPECT_EQ(popName(), "quilt piece 0");
}

TEST_F(EncodeQueueTest, eachPayerHasItsShare) {
  push(paidBy("10.0.0.1", runOf("huge", 100)), 1, 9);
  push(paidBy("10.0.0.2", runOf("small", 900)), 1, 9);
  EXPECT_EQ(popName(), "huge piece 0");
  serve(5000);
  for (int piece = 0; piece < 5; ++piece) {
    EXPECT_EQ(popName(), "small piece " + std::to_string(piece));
    serve(1001);
  }
  EXPECT_EQ(popName(), "huge piece 1");
}

TEST_F(EncodeQueueTest, tellsADeviceThatSomebodyWaitsWhoHasHadLess) {
  const Claim device{.payers = {Payer("10.0.0.1")}};
  shares_.begin(device, 5000);
  EXPECT_FALSE(queue_.hasForOthersWithLess(device)) << "nothing waits";
  push(paidBy("10.0.0.1", runOf("own", 100)), 1, 9);
  EXPECT_FALSE(queue_.hasForOthersWithLess(device));
  const AtlasRunPtr other = paidBy("10.0.0.2", runOf("other", 900));
  push(other, 1, 9);
  EXPECT_TRUE(queue_.hasForOthersWithLess(device));
  EXPECT_EQ(popName(), "other piece 0");
  serve(6000);
  EXPECT_FALSE(queue_.hasForOthersWithLess(device)) << "that one has had more by now";
  shares_.begin(device, 5000);
  EXPECT_TRUE(queue_.hasForOthersWithLess(device));
  other->giveUp();
  EXPECT_FALSE(queue_.hasForOthersWithLess(device));
}

TEST_F(EncodeQueueTest, othersWaitForTheFirstPieceOfWorkThatBeginsWithOne) {
  push(runOf("sweep", 100),
       {.strip_count = 1, .piece_count = 3, .piece_ns = 1000, .begins_with_one = true});
  push(runOf("late", 200), 1);
  EXPECT_EQ(popName(), "sweep piece 0");
  const StripBatchPtr sweep = popped_;
  EXPECT_EQ(popName(), "late strip 0");
  queue_.noteMade(*sweep);
  EXPECT_EQ(popName(), "sweep piece 1");
}

TEST_F(EncodeQueueTest, whatIsGivenUpIsDropped) {
  const AtlasRunPtr run = runOf("lens", 100);
  push(run, 1, 9);
  push(runOf("late", 200), 1);
  EXPECT_EQ(popName(), "lens piece 0");
  run->giveUp();
  EXPECT_EQ(popName(), "late strip 0");
  push(run, 1);
  queue_.close();
  EXPECT_EQ(popName(), "");
}

TEST_F(EncodeQueueTest, planesOfAStripArePackedOneByOne) {
  const AtlasRunPtr run = runOf("rgbd", 100);
  run->packs.push_back({.output = 0, .plane = AtlasPlane::kDepth, .rank = 1});
  push(run, 2);
  for (int strip = 0; strip < 2; ++strip) {
    for (size_t pack = 0; pack < 2; ++pack) {
      EXPECT_EQ(popName(), "rgbd strip " + std::to_string(strip));
      EXPECT_EQ(task_->pack, pack);
      EXPECT_GT(task_->predicted_ns, 0);
      serve(1000);
    }
  }
}

// A strip of 128 rows of a wide atlas takes long to pack.
TEST_F(EncodeQueueTest, widePlanesArePackedInSlices) {
  for (const auto& [color, least] :
       {std::pair{BandEncoding::kJpeg, 16U}, std::pair{BandEncoding::kZstd, 128U}}) {
    const AtlasRunPtr run = runOf("wide", 100, false, {16384, 300}, {.color = color});
    push(run, 3);
    uint32_t rows_left = 300;
    for (uint32_t strip = 0; strip < 3; ++strip) {
      const uint32_t row_count = run->strips.rowsOf(strip).row_count;
      for (uint32_t row = 0; row < row_count; row += task_->rows.row_count) {
        EXPECT_EQ(popName(), "wide strip " + std::to_string(strip));
        EXPECT_EQ(task_->rows.first_row, row);
        EXPECT_EQ(task_->rows.first_row % least, 0u);
        if (least == 16) {
          EXPECT_LE(task_->predicted_ns, kPiece_ns);
        } else {
          EXPECT_EQ(task_->rows.row_count, row_count) << "a Zstandard frame is whole";
        }
        rows_left -= task_->rows.row_count;
        EXPECT_EQ(run->noteEncoded(task_->rows.row_count), rows_left == 0);
        serve(task_->predicted_ns);
      }
    }
    EXPECT_EQ(rows_left, 0u);
  }
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
