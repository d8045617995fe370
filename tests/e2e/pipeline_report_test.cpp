// SPDX-License-Identifier: Apache-2.0
// Reports: the outcome of every frame, and of every display.
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "e2e/pipeline_fixture.h"

namespace viewloom::test::pipeline_report_test {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::SizeIs;
using testing::UnorderedElementsAre;

using PipelineReportTest = PipelineFixture;

TEST_F(PipelineReportTest, reportsEveryFrameExactlyOnceHoweverFastTheyCome) {
  constexpr uint64_t kFrameCount = 30;
  Server server(device());
  const Viewer viewer = watch(server, smallQuilt());
  const FramePtr first = syntheticFrame(1);
  for (uint64_t number = 1; number <= kFrameCount; ++number) {
    server.offer(movedFrame(*first, number));
  }
  const auto reports = server.reports.waitForReports(kFrameCount);
  server.pipeline.drain();
  ASSERT_THAT(server.reports.waitForReports(kFrameCount), SizeIs(kFrameCount));
  std::set<uint64_t> numbers;
  uint64_t traced_count = 0;
  for (const FrameReport& report : reports) {
    numbers.insert(report.number);
    traced_count += report.outcome == FrameOutcome::kTraced;
    EXPECT_TRUE(report.number < kFrameCount || report.outcome == FrameOutcome::kTraced);
  }
  EXPECT_THAT(numbers, SizeIs(kFrameCount));
  EXPECT_EQ(viewer.subscriber->waitForAtlases(traced_count).size(), traced_count);
}

TEST_F(PipelineReportTest, countsEveryRayOfEachDisplayThatGotTheFrame) {
  Server server(device());
  const Viewer quilt = watch(server, smallQuilt());
  const Viewer other = watch(server, smallQuilt({200, 120}));
  server.offer(syntheticFrame(1));
  const auto reports = server.reports.waitForReports(1);
  ASSERT_THAT(reports, SizeIs(1));
  EXPECT_EQ(reports[0].outcome, FrameOutcome::kTraced);
  ASSERT_THAT(
      reports[0].displays,
      UnorderedElementsAre(Field(&DisplayReport::display_id, quilt.subscription->displayId()),
                           Field(&DisplayReport::display_id, other.subscription->displayId())));
  for (const DisplayReport& display : reports[0].displays) {
    const AtlasPtr atlas = server.broadcaster.newest(display.display_id);
    EXPECT_EQ(display.coverage, atlas->coverage);
    EXPECT_EQ(display.coverage.rayCount(), atlas->layout->size_px.area());
    EXPECT_GT(display.coverage.hit, display.coverage.rayCount() / 2);
  }
}

TEST_F(PipelineReportTest, refusesADisplayOverTheLimitsAndServesTheOthers) {
  ServerOptions options;
  options.atlas_limits.side_px_max = 256;
  Server server(device(), options);
  const Viewer small = watch(server, smallQuilt({200, 120}));
  const Viewer large = watch(server, smallQuilt({320, 200}));
  server.offer(syntheticFrame(1));
  const auto end = large.subscriber->waitForEnd();
  ASSERT_TRUE(end.has_value());
  EXPECT_FALSE(end->ok());
  EXPECT_THAT(std::string(end->message()), HasSubstr("quilt.size"));
  EXPECT_THAT(small.subscriber->waitForAtlases(1), SizeIs(1));
}

TEST_F(PipelineReportTest, refusesAFrameTheDeviceCannotHoldAndGoesOn) {
  Server server(device());
  const Viewer viewer = watch(server, smallQuilt());
  auto huge = std::make_shared<Frame>(*syntheticFrame(1));
  // Declared so large that its arrays pass what one allocation may have; its planes are never read.
  const uint64_t area_px_max = device().info().limits.allocation_bytes_max / 4;
  const auto side_px = static_cast<uint32_t>(std::sqrt(double(area_px_max))) + 1;
  for (LayerFormat& layer : huge->format.sources[0].layers)
    layer.depth.size_px = {side_px, side_px};
  server.offer(huge);
  const auto reports = server.reports.waitForReports(1);
  ASSERT_THAT(reports, ElementsAre(Field(&FrameReport::outcome, FrameOutcome::kRefused)));
  EXPECT_THAT(reports[0].reason, HasSubstr("device"));
  server.offer(syntheticFrame(2));
  EXPECT_THAT(viewer.subscriber->waitForAtlases(1), SizeIs(1));
}

TEST_F(PipelineReportTest, finishesWhatHasBegunAndReportsTheRestWhenItDrains) {
  constexpr uint64_t kFrameCount = 4;
  Server server(device());
  const Viewer viewer = watch(server, smallQuilt({800, 600}));
  for (uint64_t number = 1; number <= kFrameCount; ++number) {
    server.offer(syntheticFrame(number, {160, 90}, 2, 0.1 * static_cast<double>(number)));
  }
  server.pipeline.drain();
  server.offer(syntheticFrame(kFrameCount + 1));
  const auto reports = server.reports.waitForReports(kFrameCount + 1);
  ASSERT_THAT(reports, SizeIs(kFrameCount + 1));
  EXPECT_EQ(reports.back().outcome, FrameOutcome::kRefused);
  size_t traced_count = 0;
  for (const FrameReport& report : reports) traced_count += report.outcome == FrameOutcome::kTraced;
  const auto atlases = viewer.subscriber->waitForAtlases(traced_count);
  EXPECT_THAT(atlases, SizeIs(traced_count));
  for (const AtlasPtr& atlas : atlases) EXPECT_TRUE(isWhole(*atlas));
}

}  // namespace
}  // namespace viewloom::test::pipeline_report_test
