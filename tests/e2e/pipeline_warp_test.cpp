// SPDX-License-Identifier: Apache-2.0
// A head moves for a second before a frame that stands: what it sees, and what that takes.
#include <cmath>

#include <gmock/gmock.h>

#include "e2e/pipeline_fixture.h"
#include "support/eyes/head_truth.h"
#include "support/truth/scenes.h"

namespace viewloom::test {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

constexpr SizePx kSource_px{320, 240};
constexpr double kFocal_px = 280;
constexpr uint32_t kLayerCount = 3;
constexpr SizePx kEye_px{120, 90};
constexpr int64_t kPoses_hz = 90;
constexpr double kHalfEyeDistance_m = 0.0315;

// To the sides, up and down, a step forward and back, and turning about every axis.
Pose headAt(double time_s) {
  return {.position_m = {0.06 * std::sin(2 * M_PI * time_s), 0.04 * std::sin(4 * M_PI * time_s),
                         -0.25 * std::sin(M_PI * time_s)},
          .orientation = glm::dquat(glm::dvec3(0.05 * std::sin(3 * M_PI * time_s),
                                               0.08 * std::sin(2 * M_PI * time_s),
                                               0.1 * std::sin(5 * M_PI * time_s)))};
}

EyePoses eyesOf(const Pose& head) {
  EyePoses poses;
  for (size_t eye = 0; eye < 2; ++eye) {
    const double aside_m = eye == 0 ? -kHalfEyeDistance_m : kHalfEyeDistance_m;
    poses.eyes[eye] = {.pose = compose(head, {.position_m = {aside_m, 0, 0}}),
                       .projection = fovOf(kSource_px, kFocal_px)};
  }
  return poses;
}

DisplaySpec trackedEyes() {
  return *completeDisplaySpec(
      {.kind = StereoSpec{.eye_size_px = kEye_px, .focal_distance_m = 3, .is_tracked = true}});
}

class PipelineWarpTest : public PipelineFixture {
 protected:
  PipelineWarpTest() : truth_(truth::clutteredRoom(), kSource_px, kFocal_px, kLayerCount) {}

  // The atlas after so many, by the eyes that it names.
  std::array<EyeScore, 2> scoresOf(const EncodedAtlas& atlas, const EyePoses& poses) const {
    std::array<EyeScore, 2> scores;
    for (size_t eye = 0; eye < 2; ++eye) {
      const TrackedEye& sent = poses.eyes[eye];
      const Intrinsics seen = intrinsicsFromFov(std::get<Fov>(*sent.projection), kEye_px);
      scores[eye] =
          truth_.seenBy({.pose = sent.pose, .intrinsics = seen}, kEye_px).score(atlas, eye);
    }
    return scores;
  }

  const HeadTruth truth_;
};

TEST_F(PipelineWarpTest, answersEveryPoseFromOneBuildAndAsTheWorldIs) {
  Server server(device());
  const auto eyes = std::make_shared<EyeTrack>();
  const auto subscriber = std::make_shared<CollectingSubscriber>();
  const EncodingSpec encoding{.color = BandEncoding::kRaw,
                              .with_depth = true,
                              .with_mask = true,
                              .planes = BandEncoding::kRaw};
  const auto subscription =
      *server.broadcaster.subscribe("scene", trackedEyes(), encoding, subscriber, eyes);
  server.offer(truth_.frame());
  ASSERT_THAT(subscriber->waitForAtlases(1), SizeIs(1)) << "by eyes that stand in";

  for (int64_t tick = 1; tick <= kPoses_hz; ++tick) {
    SCOPED_TRACE(tick);
    server.clock.advance(1'000'000'000 / kPoses_hz);
    // Two measurements come before the answer is begun: the newer counts.
    for (const bool is_newest : {false, true}) {
      EyePoses poses = eyesOf(headAt(double(2 * tick - !is_newest) / double(2 * kPoses_hz)));
      poses.time_ns = 2 * tick - !is_newest;
      poses.received_ns = server.clock.nowNs();
      eyes->put(std::move(poses));
    }
    server.broadcaster.announceEyes(subscription->displayId());
    const auto atlases = subscriber->waitForAtlases(size_t(tick) + 1);
    ASSERT_THAT(atlases, SizeIs(tick + 1));
    const EncodedAtlas& answer = *atlases.back();
    EXPECT_EQ(answer.frame_number, 1u);
    EXPECT_EQ(answer.eye_poses_time_ns, 2 * tick);
    EXPECT_EQ(answer.eye_poses_latched_ns, server.clock.nowNs());
    EXPECT_EQ(answer.eye_poses_age_ns, 0);
    for (const EyeScore& score :
         scoresOf(answer, eyesOf(headAt(double(tick) / double(kPoses_hz))))) {
      EXPECT_GT(score.inside_db, 30);
      EXPECT_GT(score.known_db, 20);
      EXPECT_LT(score.depth_off_share, 0.02);
      EXPECT_LT(score.outside_differs_share, 0.01);
    }
  }
  server.pipeline.drain();
  EXPECT_EQ(server.broadcaster.atlasCount(subscription->displayId()), uint64_t{kPoses_hz} + 1);
  EXPECT_EQ(server.metrics.structures_built.value(), 1);
  const std::string metrics = server.metrics.text();
  for (const char* stage : {"upload", "build"}) {
    EXPECT_THAT(metrics, HasSubstr("viewloom_stage_seconds_count{stage=\"" + std::string(stage) +
                                   "\"} 1\n"));
  }
  EXPECT_THAT(metrics, HasSubstr("viewloom_eye_poses_age_seconds_count 90\n"));
}

}  // namespace
}  // namespace viewloom::test
