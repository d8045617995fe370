// SPDX-License-Identifier: Apache-2.0
// Video on two rungs: one picture, coded twice.
#include <gmock/gmock.h>

#include "display/video_stack.h"
#include "e2e/pipeline_fixture.h"

namespace viewloom::test::pipeline_rungs_test {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr EncodingSpec kFirst = {.color = BandEncoding::kH264, .video_qp = 24, .video_qp_max = 40};

uint64_t videoBytesOf(const DisplaySpec& display) {
  const TileGrid grid = tileGridOf(display);
  return videoAtlasBytes(*planVideoStack(grid.tile_size_px, grid.view_count));
}

class PipelineRungsTest : public PipelineFixture {};

TEST_F(PipelineRungsTest, areTracedOnceAndCodedEach) {
  Server server(device());
  const Viewer first = watch(server, smallQuilt(), kFirst);
  const Viewer second = watch(server, smallQuilt(), onOtherRung(kFirst));
  server.offer(syntheticFrame(1));
  for (const Viewer* const viewer : {&first, &second}) {
    const std::vector<AtlasPtr> atlases = viewer->subscriber->waitForAtlases(1);
    ASSERT_THAT(atlases, SizeIs(1));
    EXPECT_EQ(atlases.front()->display_id, viewer->subscription->displayId());
    EXPECT_EQ(atlases.front()->sequence, 1u);
    EXPECT_EQ(atlases.front()->encoding.rung, viewer->subscription->rung());
    EXPECT_GT(atlases.front()->byteCount(), 0u);
  }
  server.pipeline.drain();
  EXPECT_EQ(tracedCount(server.metrics), 1);
  EXPECT_EQ(server.metrics.atlases_encoded.value(), 2);
}

TEST_F(PipelineRungsTest, loseTheSecondWhereMemoryIsForOne) {
  MemoryBudget memory(videoBytesOf(smallQuilt()) * 3 / 2);
  Server server(device(), {.memory = memory});
  const Viewer first = watch(server, smallQuilt(), kFirst);
  const Viewer second = watch(server, smallQuilt(), onOtherRung(kFirst));
  server.offer(syntheticFrame(1));
  const auto end = second.subscriber->waitForEnd();
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->code(), absl::StatusCode::kResourceExhausted) << *end;
  EXPECT_THAT(second.subscriber->waitForAtlases(0), IsEmpty());
  ASSERT_THAT(first.subscriber->waitForAtlases(1), SizeIs(1)) << "of the same frame";
  server.offer(movedFrame(*syntheticFrame(1), 2));
  EXPECT_THAT(first.subscriber->waitForAtlases(2), SizeIs(2));
}

}  // namespace
}  // namespace viewloom::test::pipeline_rungs_test
