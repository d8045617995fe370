// SPDX-License-Identifier: Apache-2.0
// A head moves for a second while the frame stays: the pictures it gets, and their cost.
#include <cmath>
#include <thread>

#include <gmock/gmock.h>

#include "e2e/pipeline_fixture.h"
#include "support/eyes/head_truth.h"
#include "support/truth/scenes.h"

namespace viewloom::test::pipeline_warp_test {
namespace {

using testing::SizeIs;

constexpr SizePx kSource_px{320, 240};
constexpr double kFocal_px = 280;
constexpr uint32_t kLayerCount = 3;
constexpr SizePx kEye_px{120, 90};
constexpr int64_t kPoses_hz = 90;
constexpr int64_t kAtlases_hz = 60;
constexpr int64_t kSteps_hz = 180;  // each pose and each atlas is due at one of these
constexpr int64_t kSecond_ns = 1'000'000'000;

// Time of a step, rounded up: whatever is due at this step is due by then.
constexpr int64_t sinceStartNs(int64_t step) {
  return (step * kSecond_ns + kSteps_hz - 1) / kSteps_hz;
}

constexpr glm::dvec3 kSpeed_mps{0.1, 0.04, -0.08};  // of the camera of the source
constexpr double kHalfEyeDistance_m = 0.0315;
// Two head poses are told apart by their pictures if a point in the middle of the room moves
// further than this, in output px. Nine of ten pairs do.
constexpr double kTellsApart_px = 0.1;
constexpr double kRoomMiddle_m = 3;
constexpr double kStaleLoss_db = 2;  // measured: 3.6 and more

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

constexpr EncodingSpec kExact{.color = BandEncoding::kRaw,
                              .with_depth = true,
                              .with_mask = true,
                              .planes = BandEncoding::kRaw};

// A view as wide as the source, from the current place of the source's camera.
DisplaySpec atlasesBetweenFrames() {
  return *completeDisplaySpec(
      {.kind = CamerasSpec{.cameras = {{Pose{},
                                        intrinsicsFromFov(fovOf(kSource_px, kFocal_px), kEye_px)}},
                           .tile_size_px = kEye_px,
                           .columns = 1},
       .temporal = TemporalSpec{.output_rate_hz = kAtlases_hz, .bridge_s = 2}});
}

class PipelineWarpTest : public PipelineFixture {
 protected:
  PipelineWarpTest() : truth_(truth::clutteredRoom(), kSource_px, kFocal_px, kLayerCount) {}

  struct Measured {
    EyePoses before;
    EyePoses newest;
  };

  // Two head poses arrive before the answer begins. The newer one, half a tick later, counts.
  static Measured move(Server& server, EyeTrack& eyes, int64_t tick) {
    const auto measure = [&](int64_t half_tick) {
      EyePoses poses = eyesOf(headAt(double(half_tick) / double(2 * kPoses_hz)));
      poses.time_ns = half_tick;
      poses.received_ns = server.clock.nowNs();
      eyes.put(poses);
      return poses;
    };
    const EyePoses before = measure(2 * tick - 1);
    return {.before = before, .newest = measure(2 * tick)};
  }

  // Distance in output px, seen by `to`, of the mid-room point straight ahead of `from`.
  static double movedPx(const TrackedEye& from, const TrackedEye& to) {
    const glm::dvec3 seen_m =
        from.pose.position_m + from.pose.orientation * glm::dvec3(0, 0, -kRoomMiddle_m);
    const Pose eye = inverse(to.pose);
    const glm::dvec3 at_m = eye.position_m + eye.orientation * seen_m;
    const double focal_px = kFocal_px * kEye_px.width / kSource_px.width;
    return focal_px * glm::length(glm::dvec2(at_m)) / -at_m.z;
  }

  // Scores of both views, compared with the true views of these eyes.
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

  static void expectAsTheWorldIs(const EyeScore& score) {
    EXPECT_GT(score.inside_db, 30);
    EXPECT_GT(score.known_db, 20);
    EXPECT_LT(score.depth_off_share, 0.02);
    EXPECT_LT(score.outside_differs_share, 0.01);
  }

  // Expects the views of the newest poses, not of those before. Returns true if the two differ
  // enough to tell them apart.
  bool expectAsMeasuredLast(const EncodedAtlas& answer, const Measured& measured) const {
    const std::array<EyeScore, 2> scores = scoresOf(answer, measured.newest);
    for (const EyeScore& score : scores) expectAsTheWorldIs(score);
    const double moved_px = movedPx(measured.before.eyes[0], measured.newest.eyes[0]);
    const std::array<EyeScore, 2> stale = scoresOf(answer, measured.before);
    for (size_t eye = 0; eye < 2; ++eye) {
      if (moved_px <= kTellsApart_px) continue;
      EXPECT_GT(scores[eye].inside_db, stale[eye].inside_db + kStaleLoss_db) << moved_px;
    }
    return moved_px > kTellsApart_px;
  }

  // Offers a frame of a camera at this place, captured now.
  void offer(Server& server, uint64_t number, const glm::dvec3& place_m) const {
    auto frame = std::make_shared<Frame>(*truth_.frame());
    frame->format.number = number;
    frame->format.capture_time_ns = server.clock.nowNs();
    frame->format.sources[0].camera.pose.position_m = place_m;
    frame->times = {server.clock.nowNs(), server.clock.nowNs(), server.clock.nowNs()};
    server.offer(std::move(frame));
  }

  // Expects the view of the source's camera after it has kept its velocity.
  void expectCarriedOn(const EncodedAtlas& atlas, int64_t step) const {
    const double since_s = 1e-9 * double(atlas.shown_time_ns - atlas.capture_time_ns);
    EXPECT_NEAR(since_s, double(step) / kSteps_hz, 1e-8);
    const Camera seen_from{.pose = {.position_m = since_s * kSpeed_mps},
                           .intrinsics = intrinsicsFromFov(fovOf(kSource_px, kFocal_px), kEye_px)};
    expectAsTheWorldIs(truth_.seenBy(seen_from, kEye_px).score(atlas, 0));
  }

  // Number of timed runs of a stage so far. "upload" and "build" run once a frame.
  static double stageCount(const Server& server, const std::string& stage) {
    return metricValue(server.metrics,
                       strCat("viewloom_stage_seconds_count{stage=\"", stage, "\"}"));
  }

  const HeadTruth truth_;
};

TEST_F(PipelineWarpTest, answersEveryPoseFromOneBuildAndAsTheWorldIs) {
  Server server(device());
  const auto eyes = std::make_shared<EyeTrack>();
  const auto subscriber = std::make_shared<CollectingSubscriber>();
  const auto subscription =
      *server.broadcaster.subscribe("scene", trackedEyes(), kExact, subscriber, eyes);
  server.offer(truth_.frame());
  ASSERT_THAT(subscriber->waitForAtlases(1), SizeIs(1)) << "by eyes that stand in";

  int64_t told_apart = 0;
  for (int64_t tick = 1; tick <= kPoses_hz; ++tick) {
    SCOPED_TRACE(tick);
    server.clock.advance(kSecond_ns / kPoses_hz);
    const Measured measured = move(server, *eyes, tick);
    server.pipeline.serveEyes(subscription->displayId());
    const auto atlases = subscriber->waitForAtlases(size_t(tick) + 1);
    ASSERT_THAT(atlases, SizeIs(tick + 1));
    const EncodedAtlas& answer = *atlases.back();
    EXPECT_EQ(answer.frame_number, 1u);
    EXPECT_EQ(answer.eye_poses_time_ns, 2 * tick);
    EXPECT_EQ(answer.eye_poses_latched_ns, server.clock.nowNs());
    EXPECT_EQ(answer.eye_poses_age_ns, 0);
    told_apart += expectAsMeasuredLast(answer, measured);
  }
  EXPECT_GT(told_apart, kPoses_hz / 2);
  server.pipeline.drain();
  EXPECT_EQ(server.broadcaster.atlasCount(subscription->displayId()), uint64_t{kPoses_hz} + 1);
  EXPECT_EQ(server.metrics.structures_built.value(), 1);
  for (const char* stage : {"upload", "build"}) EXPECT_EQ(stageCount(server, stage), 1) << stage;
  EXPECT_EQ(metricValue(server.metrics, "viewloom_eye_poses_age_seconds_count"), kPoses_hz);
}

// One frame, then nothing for a second, in which poses come at 90 Hz and another display of the
// stream has a rate of 60 Hz. Atlases that would show the last one again are not made, so the
// camera has to move: that it does is known from a frame a second earlier, of which alone there is
// one atlas.
TEST_F(PipelineWarpTest, answersPosesBesideADisplayOfARateOfItsOwn) {
  Server server(device());
  const auto eyes = std::make_shared<EyeTrack>();
  const Viewer between = watch(server, atlasesBetweenFrames(), kExact);
  const auto subscriber = std::make_shared<CollectingSubscriber>();
  const auto subscription =
      *server.broadcaster.subscribe("scene", trackedEyes(), kExact, subscriber, eyes);
  offer(server, 1, -kSpeed_mps);
  ASSERT_THAT(subscriber->waitForAtlases(1), SizeIs(1));
  ASSERT_THAT(between.subscriber->waitForAtlases(1), SizeIs(1));
  // The tick that is due then is taken before the frame comes.
  const double skipped_count = server.metrics.output_ticks_skipped.value();
  server.clock.advance(kSecond_ns);
  while (server.metrics.output_ticks_skipped.value() < skipped_count + double(kAtlases_hz - 1)) {
    std::this_thread::yield();
  }
  EXPECT_EQ(server.broadcaster.atlasCount(between.subscription->displayId()), 1u)
      << "of one frame alone, nothing moves";
  const double upload_count = stageCount(server, "upload");
  const double build_count = stageCount(server, "build");
  const double built_count = server.metrics.structures_built.value();
  offer(server, 2, {});
  ASSERT_THAT(subscriber->waitForAtlases(2), SizeIs(2));

  int64_t told_apart = 0;
  for (int64_t step = 1; step <= kSteps_hz; ++step) {
    SCOPED_TRACE(step);
    server.clock.advance(sinceStartNs(step) - sinceStartNs(step - 1));
    if (step % (kSteps_hz / kAtlases_hz) == 0) {
      const size_t count = 1 + size_t(step / (kSteps_hz / kAtlases_hz));
      const auto atlases = between.subscriber->waitForAtlases(count);
      ASSERT_EQ(atlases.size(), count);
      const EncodedAtlas& atlas = *atlases.back();
      EXPECT_EQ(atlas.frame_number, 2u);
      expectCarriedOn(atlas, step);
    }
    if (step % (kSteps_hz / kPoses_hz) == 0) {
      const int64_t tick = step / (kSteps_hz / kPoses_hz);
      const Measured measured = move(server, *eyes, tick);
      server.pipeline.serveEyes(subscription->displayId());
      const auto answers = subscriber->waitForAtlases(2 + size_t(tick));
      ASSERT_EQ(answers.size(), 2 + size_t(tick));
      EXPECT_EQ(answers.back()->eye_poses_time_ns, 2 * tick);
      EXPECT_EQ(answers.back()->frame_number, 2u);
      EXPECT_EQ(answers.back()->eye_poses_latched_ns, server.clock.nowNs());
      told_apart += expectAsMeasuredLast(*answers.back(), measured);
    }
  }
  server.pipeline.drain();
  EXPECT_EQ(server.broadcaster.atlasCount(subscription->displayId()), uint64_t{kPoses_hz} + 2);
  EXPECT_EQ(server.broadcaster.atlasCount(between.subscription->displayId()),
            uint64_t{kAtlases_hz} + 1);
  EXPECT_GT(told_apart, kPoses_hz / 2);
  EXPECT_EQ(stageCount(server, "upload"), upload_count + 1);
  EXPECT_EQ(stageCount(server, "build"), build_count + 1);
  EXPECT_EQ(server.metrics.structures_built.value(), built_count + 1);
}

}  // namespace
}  // namespace viewloom::test::pipeline_warp_test
