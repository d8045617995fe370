// SPDX-License-Identifier: Apache-2.0
// A stream that has sent only one frame still serves viewers from its resident frame.
#include <gmock/gmock.h>

#include "e2e/pipeline_fixture.h"

namespace viewloom::test::pipeline_resident_test {
namespace {

using testing::SizeIs;

using PipelineResidentTest = PipelineFixture;

DisplaySpec withFocus(DisplaySpec spec, double focal_distance_m) {
  std::get<QuiltSpec>(spec.kind).focal_distance_m = focal_distance_m;
  return spec;
}

TEST_F(PipelineResidentTest, servesAJoinerAStillAndAChangedFocusFromOneUploadAndOneBuild) {
  Server server(device());
  server.offer(syntheticFrame(7));
  const std::vector<FrameReport> reports = server.reports.waitForReports(1);
  ASSERT_THAT(reports, SizeIs(1));
  EXPECT_EQ(reports[0].outcome, FrameOutcome::kBuiltWithoutDisplay);

  const DisplaySpec quilt = smallQuilt();
  const Viewer joiner = watch(server, quilt);
  ASSERT_THAT(joiner.subscriber->waitForAtlases(1), SizeIs(1));

  const Viewer still = watch(server, quilt, {.color = BandEncoding::kZstd, .with_mask = true});
  ASSERT_THAT(still.subscriber->waitForAtlases(1), SizeIs(1));

  const Viewer refocused = watch(server, withFocus(quilt, 3));
  ASSERT_THAT(refocused.subscriber->waitForAtlases(1), SizeIs(1));

  for (const Viewer* viewer : {&joiner, &still, &refocused}) {
    const AtlasPtr atlas = viewer->subscriber->waitForAtlases(1).front();
    EXPECT_EQ(atlas->frame_number, 7u);
    EXPECT_EQ(atlas->sequence, 1u);
    EXPECT_TRUE(isWhole(*atlas));
    EXPECT_EQ(atlas->coverage.rayCount(), atlas->layout->size_px.area());
    ASSERT_TRUE(atlas->depth_budget);
    EXPECT_GT(atlas->depth_budget->disparity_max_px, 0);
    EXPECT_EQ(server.broadcaster.layout(atlas->display_id), atlas->layout);
  }
  EXPECT_EQ(refocused.subscriber->waitForAtlases(1).front()->layout->focal_distance_m, 3);
  EXPECT_EQ(server.metrics.structures_built.value(), 1);
  EXPECT_EQ(tracedCount(server.metrics), 3);
  EXPECT_THAT(joiner.subscriber->waitForAtlases(1), SizeIs(1)) << "others' wishes cost it nothing";
}

TEST_F(PipelineResidentTest, walksWhatCannotBeSweptFromTheSameFrame) {
  Server server(device());
  server.offer(syntheticFrame(7));
  const Viewer quilt = watch(server, smallQuilt());
  const auto swept = quilt.subscriber->waitForAtlases(1);
  ASSERT_THAT(swept, SizeIs(1));
  // A GPU walks everything.
  EXPECT_EQ(swept[0]->method == TraceMethod::kSweep, device().info().is_software);

  const Viewer camera = watch(server, turnedCamera());
  const auto walked = camera.subscriber->waitForAtlases(1);
  ASSERT_THAT(walked, SizeIs(1));
  EXPECT_EQ(walked[0]->method, TraceMethod::kWalk);
  EXPECT_EQ(walked[0]->frame_number, 7u);
  EXPECT_GT(walked[0]->coverage.hit, 0u);

  // Now that the stream is walked, its next frame is built for both.
  server.offer(syntheticFrame(8, {160, 90}, 2, 1));
  EXPECT_EQ(quilt.subscriber->waitForAtlases(2).at(1)->method, swept[0]->method);
  EXPECT_EQ(camera.subscriber->waitForAtlases(2).at(1)->method, TraceMethod::kWalk);
  EXPECT_EQ(server.metrics.structures_built.value(), 2);
}

TEST_F(PipelineResidentTest, tracesOnceForAllWhoShareAPictureAndEncodesOnceForEachEncoding) {
  Server server(device());
  const DisplaySpec quilt = smallQuilt();
  const Viewer first = watch(server, quilt);
  const Viewer second = watch(server, quilt);
  const Viewer fine = watch(server, quilt, {.jpeg_quality = 95, .chroma = Chroma::k444});
  server.offer(syntheticFrame(1));
  for (const Viewer* viewer : {&first, &second, &fine}) {
    ASSERT_THAT(viewer->subscriber->waitForAtlases(1), SizeIs(1));
  }
  server.pipeline.drain();
  EXPECT_EQ(tracedCount(server.metrics), 1);
  EXPECT_EQ(server.metrics.atlases_encoded.value(), 2);
  EXPECT_EQ(first.subscriber->waitForAtlases(1).front(),
            second.subscriber->waitForAtlases(1).front())
      << "the same bytes, shared";
}

TEST_F(PipelineResidentTest, holdsTheFocalDistanceOfTheFirstFrame) {
  Server server(device());
  const Viewer viewer = watch(server, smallQuilt());
  server.offer(syntheticFrame(1, {160, 90}, 1, 0));
  ASSERT_THAT(viewer.subscriber->waitForAtlases(1), SizeIs(1));
  server.offer(syntheticFrame(2, {160, 90}, 1, 5));
  const auto atlases = viewer.subscriber->waitForAtlases(2);
  ASSERT_THAT(atlases, SizeIs(2));
  const double first_m = atlases[0]->layout->focal_distance_m;
  EXPECT_EQ(atlases[1]->layout->focal_distance_m, first_m);
  // The harmonic mean of the 2nd and 98th depth percentile, as the frame's own stats have them.
  const SourceStats& stats = atlases[0]->stats;
  EXPECT_NEAR(first_m, 2 / (stats.inv_z_near + stats.inv_z_far), 1e-6 * first_m);
}

TEST_F(PipelineResidentTest, forgetsAStreamWithItsStructure) {
  Server server(device());
  server.offer(syntheticFrame(1));
  ASSERT_THAT(server.reports.waitForReports(1), SizeIs(1));
  server.pipeline.forgetStream("scene");
  const Viewer viewer = watch(server, smallQuilt());
  server.offer(syntheticFrame(2));
  const auto atlases = viewer.subscriber->waitForAtlases(1);
  ASSERT_THAT(atlases, SizeIs(1));
  EXPECT_EQ(atlases[0]->frame_number, 2u);
}

}  // namespace
}  // namespace viewloom::test::pipeline_resident_test
