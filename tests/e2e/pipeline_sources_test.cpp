// SPDX-License-Identifier: Apache-2.0
// Frames of several sources on their way through the pipeline.
#include <gmock/gmock.h>

#include "e2e/pipeline_fixture.h"

namespace viewloom::test::pipeline_sources_test {
namespace {

using testing::SizeIs;

class PipelineSourcesTest : public PipelineFixture {
 protected:
  AtlasPtr atlasOf(const FramePtr& frame, ServerOptions options = {}) {
    Server server(device(), options);
    const Viewer viewer =
        watch(server, smallQuilt({400, 300}), {.with_depth = true, .with_mask = true});
    server.offer(frame);
    const std::vector<AtlasPtr> atlases = viewer.subscriber->waitForAtlases(1);
    const std::vector<FrameReport> reports = server.reports.waitForReports(1);
    EXPECT_THAT(reports, SizeIs(1));
    EXPECT_EQ(reports.front().outcome, FrameOutcome::kTraced);
    EXPECT_THAT(atlases, SizeIs(1));
    return atlases.empty() ? nullptr : atlases.front();
  }
};

TEST_F(PipelineSourcesTest, showWhatIsHiddenFromOneOfThem) {
  const AtlasPtr one = atlasOf(syntheticFrameFrom(1, {0}));
  const AtlasPtr three = atlasOf(syntheticFrameFrom(1, {0, -0.6, 0.6}));
  ASSERT_TRUE(one && three);
  EXPECT_EQ(three->method, TraceMethod::kWalk);
  EXPECT_EQ(one->coverage.rayCount(), three->coverage.rayCount());
  EXPECT_GT(one->coverage.hidden, one->coverage.rayCount() / 100);
  EXPECT_LT(3 * three->coverage.hidden, one->coverage.hidden);
}

TEST_F(PipelineSourcesTest, giveTheSameBytesWhateverTheThreadsAndTheSlots) {
  for (const FramePtr& frame : {syntheticFrameFrom(1, {0, 0.5}), syntheticCubeFrame(1)}) {
    const AtlasPtr a = atlasOf(frame, {.encode_thread_count = 1, .trace_slot_count = 1});
    const AtlasPtr b = atlasOf(frame, {.encode_thread_count = 4, .trace_slot_count = 5});
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->bands.size(), b->bands.size());
    for (size_t i = 0; i < a->bands.size(); ++i) {
      EXPECT_EQ(*a->bands[i].bytes, *b->bands[i].bytes) << "band " << i;
    }
    EXPECT_EQ(a->coverage, b->coverage);
  }
}

TEST_F(PipelineSourcesTest, thatAreCubeMapsSeeEverything) {
  const AtlasPtr atlas = atlasOf(syntheticCubeFrame(1));
  ASSERT_TRUE(atlas);
  EXPECT_EQ(atlas->method, TraceMethod::kWalk);
  EXPECT_EQ(atlas->coverage.outside, 0U);
  EXPECT_GT(atlas->coverage.hit, atlas->coverage.rayCount() * 3 / 4);
}

// Slots that held one source hold two, a cube map, and one again.
TEST_F(PipelineSourcesTest, mayComeAndGoFromFrameToFrame) {
  Server server(device(), {.trace_slot_count = 1});
  const Viewer viewer = watch(server, smallQuilt());
  for (uint64_t number = 1; number <= 7; ++number) {
    server.offer(number % 3 == 1   ? syntheticFrameFrom(number, {0})
                 : number % 3 == 2 ? syntheticFrameFrom(number, {0, 0.4, 0.8}, {120, 70})
                                   : syntheticCubeFrame(number));
    EXPECT_THAT(server.reports.waitForReports(number), SizeIs(number));
    EXPECT_THAT(viewer.subscriber->waitForAtlases(number), SizeIs(number));
  }
}

}  // namespace
}  // namespace viewloom::test::pipeline_sources_test
