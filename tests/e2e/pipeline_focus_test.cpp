// SPDX-License-Identifier: Apache-2.0
// A focal plane that follows what frames show, by a clock that the test turns.
#include <cmath>

#include <gmock/gmock.h>

#include "display/focus_follower.h"
#include "e2e/pipeline_fixture.h"

namespace viewloom::test::pipeline_focus_test {
namespace {

using testing::SizeIs;

using PipelineFocusTest = PipelineFixture;

// Everything of it shrunk or grown around the camera.
FramePtr scaled(uint64_t number, float scale) {
  auto frame = std::make_shared<Frame>(*syntheticFrame(number, {160, 90}, 2, 0.1 * double(number)));
  for (LayerFormat& layer : frame->format.sources[0].layers) layer.depth.depth.scale *= scale;
  return frame;
}

TEST_F(PipelineFocusTest, goesToWhatTheBudgetSuggestsAsTimePasses) {
  constexpr double kTimeConstant_s = 0.5;
  Server server(device());
  DisplaySpec following = smallQuilt();
  following.focus_following_s = kTimeConstant_s;
  const Viewer follower = watch(server, following);
  const Viewer other = watch(server, smallQuilt());
  double inv_focus = 0;
  for (uint64_t number = 1; number <= 6; ++number) {
    server.offer(scaled(number, number < 3 ? 1.0F : 0.25F));
    const auto reports = server.reports.waitForReports(number);
    ASSERT_THAT(reports, SizeIs(number));
    ASSERT_EQ(reports.back().outcome, FrameOutcome::kTraced);
    const AtlasPtr atlas = follower.subscriber->waitForAtlases(number).back();
    const AtlasPtr fixed = other.subscriber->waitForAtlases(number).back();
    const double suggested = 1 / atlas->depth_budget->suggested_focal_distance_m;
    // By the formula from frame to frame, up to what nobody would see.
    if (number == 1) inv_focus = 1 / fixed->layout->focal_distance_m;
    if (number > 1) inv_focus += (suggested - inv_focus) * (1 - std::exp(-0.1 / kTimeConstant_s));
    const double unseen = kFocusStep_px / disparityPerInvZ(*atlas->layout);
    EXPECT_NEAR(1 / atlas->layout->focal_distance_m, inv_focus, unseen) << number;
    EXPECT_EQ(fixed->layout->focal_distance_m,
              other.subscriber->waitForAtlases(1).front()->layout->focal_distance_m);
    server.clock.advance(100'000'000);
  }
  // The scene came four times as near: what is suggested too, and the plane is on its way there.
  const auto atlases = follower.subscriber->waitForAtlases(6);
  EXPECT_GT(1 / atlases[5]->depth_budget->suggested_focal_distance_m,
            2 / atlases[1]->depth_budget->suggested_focal_distance_m);
  EXPECT_LT(atlases[5]->layout->focal_distance_m, atlases[1]->layout->focal_distance_m);
}

TEST_F(PipelineFocusTest, costsNothingWhileNothingMoves) {
  Server server(device());
  DisplaySpec following = smallQuilt();
  following.focus_following_s = 0.5;
  const Viewer viewer = watch(server, following);
  for (uint64_t number = 1; number <= 5; ++number) {
    server.offer(syntheticFrame(number));
    ASSERT_THAT(server.reports.waitForReports(number), SizeIs(number));
    server.clock.advance(1'000'000'000);
  }
  server.pipeline.drain();
  EXPECT_EQ(server.metrics.atlases_encoded.value(), 1);
}

}  // namespace
}  // namespace viewloom::test::pipeline_focus_test
