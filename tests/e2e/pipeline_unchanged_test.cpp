// SPDX-License-Identifier: Apache-2.0
// A frame that equals the resident one costs nothing, and nobody misses anything by it.
#include <cmath>

#include <gmock/gmock.h>

#include "e2e/pipeline_fixture.h"

namespace viewloom::test::pipeline_unchanged_test {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

constexpr SizePx kSizePx{160, 90};

// Counts of the work done for all frames so far.
struct Work {
  double built = 0;
  double traced = 0;
  double encoded = 0;

  bool operator==(const Work&) const = default;
};

Work workOf(const Metrics& metrics) {
  return {.built = metrics.structures_built.value(),
          .traced = tracedCount(metrics),
          .encoded = metrics.atlases_encoded.value()};
}

std::vector<FrameOutcome> outcomesOf(const std::vector<FrameReport>& reports) {
  std::vector<FrameOutcome> outcomes;
  for (const FrameReport& report : reports) outcomes.push_back(report.outcome);
  return outcomes;
}

class PipelineUnchangedTest : public PipelineFixture {
 protected:
  // The outcome of a frame, once it is known; frames are offered by this alone.
  FrameOutcome outcomeOf(Server& server, FramePtr frame) {
    server.offer(std::move(frame));
    return server.reports.waitForReports(++offered_count_).back().outcome;
  }

 private:
  size_t offered_count_ = 0;
};

TEST_F(PipelineUnchangedTest, isNeitherBuiltNorTracedNorEncoded) {
  Server server(device());
  const Viewer viewer = watch(server, smallQuilt());
  EXPECT_EQ(outcomeOf(server, syntheticFrame(1)), FrameOutcome::kTraced);
  const Work first = workOf(server.metrics);
  for (uint64_t number = 2; number <= 6; ++number) {
    EXPECT_EQ(outcomeOf(server, syntheticFrame(number)), FrameOutcome::kUnchanged);
  }
  EXPECT_EQ(server.metrics.frames_unchanged.value(), 5);
  EXPECT_EQ(outcomeOf(server, syntheticFrame(7, kSizePx, 2, 1)), FrameOutcome::kTraced);
  server.pipeline.drain();
  EXPECT_EQ(first, (Work{.built = 1, .traced = 1, .encoded = 1}));
  EXPECT_EQ(workOf(server.metrics), (Work{.built = 2, .traced = 2, .encoded = 2}));
  const auto atlases = viewer.subscriber->waitForAtlases(2);
  ASSERT_THAT(atlases, SizeIs(2));
  EXPECT_EQ(atlases[0]->frame_number, 1u);
  EXPECT_EQ(atlases[1]->frame_number, 7u);
}

TEST_F(PipelineUnchangedTest, isToldWithTheStatsOfWhatStands) {
  Server server(device());
  server.offer(syntheticFrame(1));
  ASSERT_THAT(server.reports.waitForReports(1), SizeIs(1));
  server.offer(syntheticFrame(2));
  const auto reports = server.reports.waitForReports(2);
  ASSERT_THAT(outcomesOf(reports),
              ElementsAre(FrameOutcome::kBuiltWithoutDisplay, FrameOutcome::kUnchanged));
  EXPECT_EQ(reports[1].number, 2u);
  EXPECT_EQ(reports[1].stats.depth_step, reports[0].stats.depth_step);
  EXPECT_GT(reports[1].stats.inv_z_near, 0);
}

TEST_F(PipelineUnchangedTest, isComparedWithTheResidentFrameAndNotWithTheLastOne) {
  Server server(device());
  const Viewer viewer = watch(server, smallQuilt());
  EXPECT_EQ(outcomeOf(server, syntheticFrame(1)), FrameOutcome::kTraced);
  // Refused: larger than the device can hold.
  auto huge = std::make_shared<Frame>(*syntheticFrame(2));
  const uint64_t area_px_max = device().info().limits.allocation_bytes_max / 4;
  const auto side_px = static_cast<uint32_t>(std::sqrt(double(area_px_max))) + 1;
  for (LayerFormat& layer : huge->format.sources[0].layers) {
    layer.depth.size_px = {side_px, side_px};
  }
  EXPECT_EQ(outcomeOf(server, huge), FrameOutcome::kRefused);
  EXPECT_EQ(outcomeOf(server, syntheticFrame(3)), FrameOutcome::kUnchanged);
  EXPECT_EQ(outcomeOf(server, syntheticFrame(4, kSizePx, 2, 1)), FrameOutcome::kTraced);
  // Equal to the first frame, which is no longer resident.
  EXPECT_EQ(outcomeOf(server, syntheticFrame(5)), FrameOutcome::kTraced);
  EXPECT_EQ(viewer.subscriber->waitForAtlases(3).back()->frame_number, 5u);
}

TEST_F(PipelineUnchangedTest, leavesTheNewestContentResidentHoweverFastFramesCome) {
  constexpr uint64_t kFrameCount = 40;
  Server server(device());
  const Viewer viewer = watch(server, smallQuilt());
  // Runs of equal frames; the last is unlike the run before it.
  for (uint64_t number = 1; number <= kFrameCount; ++number) {
    const uint64_t content = number == kFrameCount ? kFrameCount : number / 5;
    server.offer(syntheticFrame(number, kSizePx, 2, 0.1 * static_cast<double>(content)));
  }
  ASSERT_THAT(server.reports.waitForReports(kFrameCount), SizeIs(kFrameCount));
  server.pipeline.drain();
  const uint64_t display_id = viewer.subscription->displayId();
  ASSERT_NE(server.broadcaster.newest(display_id), nullptr);
  EXPECT_EQ(server.broadcaster.newest(display_id)->frame_number, kFrameCount);
}

TEST_F(PipelineUnchangedTest, doesNotKeepAJoinerOrOneWhoNeedsTheWalkFromItsAtlas) {
  Server server(device());
  const Viewer quilt = watch(server, smallQuilt());
  EXPECT_EQ(outcomeOf(server, syntheticFrame(1)), FrameOutcome::kTraced);
  EXPECT_EQ(outcomeOf(server, syntheticFrame(2)), FrameOutcome::kUnchanged);
  const Viewer joiner = watch(server, smallQuilt({200, 120}));
  ASSERT_THAT(joiner.subscriber->waitForAtlases(1), SizeIs(1));
  const Viewer camera = watch(server, turnedCamera());
  ASSERT_THAT(camera.subscriber->waitForAtlases(1), SizeIs(1));
  EXPECT_EQ(camera.subscriber->waitForAtlases(1).front()->method, TraceMethod::kWalk);
  EXPECT_EQ(outcomeOf(server, syntheticFrame(3)), FrameOutcome::kUnchanged);
  // The walk was not forgotten over it: the next frame serves all three.
  EXPECT_EQ(outcomeOf(server, syntheticFrame(4, kSizePx, 2, 1)), FrameOutcome::kTraced);
  for (const Viewer* viewer : {&quilt, &joiner, &camera}) {
    const auto atlases = viewer->subscriber->waitForAtlases(2);
    ASSERT_THAT(atlases, SizeIs(2));
    EXPECT_EQ(atlases[0]->frame_number, 1u);
    EXPECT_EQ(atlases[1]->frame_number, 4u);
  }
  EXPECT_EQ(server.metrics.structures_built.value(), 2);
}

TEST_F(PipelineUnchangedTest, isThatAlsoOfACubeMap) {
  Server server(device());
  EXPECT_EQ(outcomeOf(server, syntheticCubeFrame(1)), FrameOutcome::kBuiltWithoutDisplay);
  EXPECT_EQ(outcomeOf(server, syntheticCubeFrame(2)), FrameOutcome::kUnchanged);
}

}  // namespace
}  // namespace viewloom::test::pipeline_unchanged_test
