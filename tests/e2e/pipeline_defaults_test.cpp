// SPDX-License-Identifier: Apache-2.0
// Defaults of a stream are taken anew for a new session, and when depth moves far.
#include <gmock/gmock.h>

#include "e2e/pipeline_fixture.h"

namespace viewloom::test::pipeline_defaults_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// The synthetic scene, scaled around the camera.
FramePtr scaled(uint64_t number, double scale) {
  auto frame =
      std::make_shared<Frame>(*syntheticFrame(number, {160, 90}, 2, 0.01 * double(number)));
  for (LayerFormat& layer : frame->format.sources[0].layers) layer.depth.depth.scale *= scale;
  return frame;
}

class PipelineDefaultsTest : public PipelineFixture {
 protected:
  FrameReport report(Server& server, FramePtr frame, uint64_t session) {
    server.offer(std::move(frame), "scene", session);
    return server.reports.waitForReports(++offered_count_).back();
  }

 private:
  size_t offered_count_ = 0;
};

TEST_F(PipelineDefaultsTest, aNewSessionStartsTheFocalPlaneAnew) {
  Server server(device());
  const Viewer viewer = watch(server, smallQuilt());
  report(server, scaled(1, 1000), 1);  // millimetres taken for metres
  report(server, scaled(2, 1), 2);
  Server other(device());
  const Viewer right = watch(other, smallQuilt());
  other.offer(scaled(2, 1));
  const AtlasPtr expected = right.subscriber->waitForAtlases(1).front();
  const auto atlases = viewer.subscriber->waitForAtlases(2);
  ASSERT_THAT(atlases, SizeIs(2));
  EXPECT_GT(atlases[0]->layout->focal_distance_m, 100 * expected->layout->focal_distance_m);
  EXPECT_EQ(atlases[1]->layout->focal_distance_m, expected->layout->focal_distance_m);
  EXPECT_EQ(atlases[1]->taking, (DefaultsTaking{2, DefaultsReason::kNewPublisher}));
}

TEST_F(PipelineDefaultsTest, aSessionThatComesBackKeepsWhatItHad) {
  Server server(device());
  const Viewer viewer = watch(server, smallQuilt());
  report(server, scaled(1, 1), 1);
  EXPECT_THAT(report(server, scaled(2, 1.5), 1).note, IsEmpty());
  const auto atlases = viewer.subscriber->waitForAtlases(2);
  EXPECT_EQ(atlases[0]->layout, atlases[1]->layout);
}

TEST_F(PipelineDefaultsTest, aNewSessionThatBeginsWithTheResidentFrameTakesItsDefaults) {
  Server server(device());
  const Viewer viewer = watch(server, smallQuilt());
  report(server, scaled(1, 1), 1);
  report(server, scaled(2, 2), 1);
  EXPECT_EQ(report(server, scaled(2, 2), 2).outcome, FrameOutcome::kTraced);
  const auto atlases = viewer.subscriber->waitForAtlases(3);
  ASSERT_THAT(atlases, SizeIs(3));
  EXPECT_EQ(atlases[1]->layout, atlases[0]->layout);
  EXPECT_NEAR(atlases[2]->layout->focal_distance_m, 2 * atlases[0]->layout->focal_distance_m,
              0.2 * atlases[0]->layout->focal_distance_m);
  EXPECT_EQ(report(server, scaled(2, 2), 3).outcome, FrameOutcome::kUnchanged);
}

TEST_F(PipelineDefaultsTest, depthThatMovesByMoreThanAFactorOfFourIsFollowedAndTold) {
  Server server(device());
  const Viewer viewer = watch(server, smallQuilt());
  report(server, scaled(1, 1), 1);
  EXPECT_THAT(report(server, scaled(2, 3), 1).note, IsEmpty());
  const FrameReport moved = report(server, scaled(3, 1000), 1);
  EXPECT_THAT(moved.note, HasSubstr("taken anew from this frame"));
  const auto atlases = viewer.subscriber->waitForAtlases(3);
  ASSERT_THAT(atlases, SizeIs(3));
  EXPECT_EQ(atlases[1]->layout, atlases[0]->layout);
  EXPECT_GT(atlases[2]->layout->focal_distance_m, 500 * atlases[0]->layout->focal_distance_m);
  EXPECT_EQ(atlases[2]->taking, (DefaultsTaking{2, DefaultsReason::kDepthMoved}));
  EXPECT_EQ(report(server, scaled(3, 1000), 1).outcome, FrameOutcome::kUnchanged);
}

TEST_F(PipelineDefaultsTest, aDisplayThatSaysItsFocalPlaneKeepsIt) {
  Server server(device());
  DisplaySpec spec = smallQuilt();
  std::get<QuiltSpec>(spec.kind).focal_distance_m = 3;
  const Viewer viewer = watch(server, spec);
  report(server, scaled(1, 1), 1);
  report(server, scaled(2, 1000), 1);
  report(server, scaled(3, 1), 2);
  const auto atlases = viewer.subscriber->waitForAtlases(3);
  ASSERT_THAT(atlases, SizeIs(3));
  for (const AtlasPtr& atlas : atlases) EXPECT_EQ(atlas->layout->focal_distance_m, 3);
}

TEST_F(PipelineDefaultsTest, aFocalPlaneThatFollowsBeginsWhereTheNewDefaultsHaveIt) {
  Server server(device());
  DisplaySpec following = smallQuilt();
  following.focus_following_s = 0.5;
  const Viewer follower = watch(server, following);
  const Viewer fixed = watch(server, smallQuilt());
  for (uint64_t number = 1; number <= 3; ++number) {
    report(server, scaled(number, number < 3 ? 1000 : 1), number < 3 ? 1 : 2);
    server.clock.advance(100'000'000);
  }
  EXPECT_EQ(follower.subscriber->waitForAtlases(3).back()->layout->focal_distance_m,
            fixed.subscriber->waitForAtlases(3).back()->layout->focal_distance_m);
}

}  // namespace
}  // namespace viewloom::test::pipeline_defaults_test
