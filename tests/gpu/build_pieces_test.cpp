// SPDX-License-Identifier: Apache-2.0
// Builds that are cut into pieces: none is predicted to take longer than asked, and the structure
// is the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "gpu/walk_under_test.h"
#include "structure/build_costs.h"
#include "structure/cut_recording.h"
#include "support/test_device.h"
#include "support/test_frames.h"

namespace viewloom::build_pieces_test {
namespace {

constexpr int64_t kTime_ns = 1'000'000;

TEST(CutRecording, takesNoMoreRowsThanFitIntoAPiece) {
  const BuildCosts costs(10);
  std::vector<int64_t> pieces_ns;
  CutRecording recording(Commands(nullptr), costs, kTime_ns, [&](const BuiltPx& recorded) {
    pieces_ns.push_back(costs.predictNs(recorded));
    return Commands(nullptr);
  });
  const auto record = [&](BuildPass pass, uint64_t row_px_count, uint64_t row_count) {
    uint64_t taken = 0;
    while (taken < row_count) taken += recording.takeRows(pass, row_px_count, row_count - taken);
    EXPECT_EQ(taken, row_count);
  };
  record(BuildPass::kPrepare, 7'000, 300);
  record(BuildPass::kLevels, 1, 5);
  record(BuildPass::kMeasure, 90'000, 12);  // two do not fit
  record(BuildPass::kFacets, 7'000, 300);
  recording.cut();
  const uint64_t px_count = 2 * 7'000 * 300 + 5 + 90'000 * 12;
  int64_t all_ns = 0;
  for (const int64_t piece_ns : pieces_ns) {
    EXPECT_LE(piece_ns, kTime_ns);
    all_ns += piece_ns;
  }
  EXPECT_EQ(all_ns, int64_t(10 * px_count));
  EXPECT_TRUE(recording.recorded().isEmpty());
}

TEST(CutRecording, makesPiecesOfSingleRowsWhereThoseTakeLonger) {
  const BuildCosts costs(10);
  size_t piece_count = 0;
  CutRecording recording(Commands(nullptr), costs, kTime_ns, [&](const BuiltPx& recorded) {
    ++piece_count;
    EXPECT_EQ(recorded.of(BuildPass::kSmooth), 200'000u);
    return Commands(nullptr);
  });
  for (int row = 0; row < 4; ++row) {
    EXPECT_EQ(recording.takeRows(BuildPass::kSmooth, 200'000, 4 - row), 1u);
  }
  EXPECT_EQ(piece_count, 3u) << "the last is not cut yet";
}

// Passes that are seldom together: each keeps its own cost.
TEST(BuildCosts, learnWhatEachPassTakes) {
  BuildCosts costs(50);
  for (int i = 0; i < 60; ++i) {
    BuiltPx levels;
    levels.add(BuildPass::kLevels, 1000);
    costs.note(levels, 2'000);
    BuiltPx both;
    both.add(BuildPass::kFacets, 10'000);
    both.add(BuildPass::kLevels, 1000);
    costs.note(both, 10'000 * 30 + 2'000);
  }
  EXPECT_NEAR(costs.nsPerPx(BuildPass::kLevels), 2, 0.5);
  EXPECT_NEAR(costs.nsPerPx(BuildPass::kFacets), 30, 3);
  EXPECT_EQ(costs.nsPerPx(BuildPass::kSmooth), 50);
}

class BuildPiecesTest : public GpuTest {
 protected:
  // Built in pieces of single rows; how many.
  size_t buildInRows(const StructureSlot& slot) {
    const BuildCosts costs(1e9);
    Timeline timeline(device());
    CommandRecorder recorder(device());
    size_t piece_count = 1;
    CutRecording cuts(recorder.begin(), costs, kTime_ns, [&](const BuiltPx&) {
      ++piece_count;
      timeline.wait(recorder.submit(timeline));
      return recorder.begin();
    });
    shared<StructureBuilder>().record(cuts, slot);
    timeline.wait(recorder.submit(timeline));
    return piece_count;
  }

  void expectSame(const StructureSlot& built, const StructureSlot& other, uint32_t layer_count) {
    for (uint32_t layer = 0; layer < layer_count; ++layer) {
      const std::vector<abi::uvec2> cells = walk_.cells(built, layer);
      const std::vector<abi::uvec2> other_cells = walk_.cells(other, layer);
      ASSERT_EQ(cells.size(), other_cells.size());
      size_t apart = 0;
      for (size_t i = 0; i < cells.size(); ++i) {
        apart += cells[i].x != other_cells[i].x || cells[i].y != other_cells[i].y;
      }
      EXPECT_EQ(apart, 0u) << "layer " << layer;
    }
  }

  WalkUnderTest walk_{device()};
};

// With depth that is smoothed, pass by pass of rows, and with such as is left as it is.
TEST_F(BuildPiecesTest, makeTheSameStructure) {
  for (const bool is_coarse : {true, false}) {
    SCOPED_TRACE(is_coarse ? "coarse" : "fine");
    const oracle::Scene scene =
        is_coarse ? oracle::coarseScene(1, 201, 101, 2) : oracle::smoothScene(201, 101, 2);
    const FramePtr frame = frameOf(scene);
    const std::unique_ptr<StructureSlot> whole = walk_.build(*frame, 0);
    EXPECT_EQ(whole->stats().smoothing_reach > 0, is_coarse);
    const std::unique_ptr<StructureSlot> cut = walk_.build(*frame, 0);
    const size_t piece_count = buildInRows(*cut);
    const size_t block_rows = (101 + 3) / 4;
    EXPECT_GT(piece_count, (is_coarse ? 6 : 4) * block_rows);
    expectSame(*whole, *cut, 2);
    EXPECT_EQ(whole->stats().smoothing_reach, cut->stats().smoothing_reach);
  }
}

}  // namespace
}  // namespace viewloom::build_pieces_test
