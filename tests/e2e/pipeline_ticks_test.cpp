// SPDX-License-Identifier: Apache-2.0
// Displays with an output rate of their own: what they get between frames, by a clock that the test
// turns.
#include <thread>

#include <gmock/gmock.h>

#include <glm/geometric.hpp>

#include "e2e/ticks_fixture.h"

namespace viewloom::test::pipeline_ticks_test {
namespace {

using testing::SizeIs;

constexpr glm::dvec3 kSpeed_mps{0.2, -0.1, 0.05};

glm::dvec3 placeAt(int64_t captured_ns) {
  return 1e-9 * double(captured_ns - kStart_ns) * kSpeed_mps;
}

// Arrives at the server's `now_ns`, at once.
FramePtr frameAt(uint64_t number, int64_t now_ns, const glm::dvec3& place_m) {
  auto frame = std::make_shared<Frame>(*syntheticFrame(number));
  frame->format.capture_time_ns = kStart_ns + now_ns;
  frame->format.sources[0].camera.pose.position_m = place_m;
  frame->times = {now_ns, now_ns, now_ns};
  return frame;
}

class PipelineTicksTest : public TicksFixture {
 protected:
  static double tracedCount(const Server& server) {
    return server.metrics.atlases_traced[TraceMethod::kWalk].value() +
           server.metrics.atlases_traced[TraceMethod::kSweep].value();
  }

  // Offers a frame of the moving camera, captured now.
  static void offerMoving(Server& server, uint64_t number) {
    const int64_t now_ns = server.clock.nowNs();
    server.offer(frameAt(number, now_ns, placeAt(kStart_ns + now_ns)));
  }

  // Two frames of the moving camera; the first atlas of the second.
  static AtlasPtr begin(Server& server, const Viewer& viewer) {
    offerMoving(server, 1);
    const AtlasPtr first = viewer.subscriber->waitForAtlases(1).front();
    EXPECT_EQ(first->timing, Timing::kCaptured);
    EXPECT_EQ(first->shown_time_ns, first->capture_time_ns);
    EXPECT_EQ(first->display_pose, first->source_camera.pose);
    server.clock.advance(kFrame_ns);
    offerMoving(server, 2);
    return next(server, viewer);
  }
};

TEST_F(PipelineTicksTest, carriesTheCameraOnBetweenFrames) {
  Server server(device());
  const Viewer viewer = watch(server, ticking());
  AtlasPtr atlas = begin(server, viewer);
  const Pose captured{.position_m = placeAt(atlas->capture_time_ns)};
  int64_t shown_ns = atlas->capture_time_ns;
  while (atlas->shown_time_ns < atlas->capture_time_ns + kFrame_ns) {
    EXPECT_EQ(atlas->frame_number, 2u);
    EXPECT_EQ(atlas->timing, Timing::kPredicted);
    EXPECT_EQ(atlas->source_camera.pose, captured);
    EXPECT_GT(atlas->shown_time_ns, shown_ns);
    EXPECT_EQ((atlas->shown_time_ns - atlas->capture_time_ns) % kTick_ns, 0);
    EXPECT_LT(glm::length(atlas->display_pose.position_m - placeAt(atlas->shown_time_ns)), 1e-9);
    shown_ns = atlas->shown_time_ns;
    atlas = next(server, viewer);
  }
  server.pipeline.drain();
  EXPECT_EQ(server.metrics.structures_built.value(), 2) << "nothing is built between frames";
  EXPECT_EQ(server.metrics.structures_retimed.value(), 0);
}

TEST_F(PipelineTicksTest, bridgesALateFrameThenHoldsThenTellsOnce) {
  Server server(device());
  const Viewer viewer = watch(server, ticking());
  AtlasPtr atlas = begin(server, viewer);
  while (atlas->timing == Timing::kPredicted) {
    EXPECT_LT(atlas->shown_time_ns, atlas->capture_time_ns + kBridge_ns);
    atlas = next(server, viewer);
  }
  EXPECT_EQ(atlas->timing, Timing::kHeld);
  EXPECT_EQ(atlas->shown_time_ns, atlas->capture_time_ns + kBridge_ns);
  server.clock.advance(10 * kFrame_ns);
  offerMoving(server, 3);
  const AtlasPtr third = next(server, viewer);
  EXPECT_EQ(third->frame_number, 3u);
  EXPECT_EQ(third->sequence, atlas->sequence + 1) << "nothing came while it was held";
}

TEST_F(PipelineTicksTest, costsNothingWhileNothingMoves) {
  Server server(device());
  const Viewer viewer = watch(server, ticking());
  const Viewer in_world = watch(server, [] {
    DisplaySpec spec = smallQuilt({64, 40});
    spec.world_pose = Pose{};
    return ticking(spec);
  }());
  for (uint64_t number = 1; number <= 4; ++number) {
    server.offer(frameAt(number, server.clock.nowNs(), {}));
    server.reports.waitForReports(number);
    server.clock.advance(kFrame_ns);
  }
  server.clock.advance(10 * kFrame_ns);
  // A joiner of another encoding gets the atlas that stands, at the next tick.
  const Viewer joiner = watch(server, ticking(), {.color = BandEncoding::kRaw});
  server.clock.advance(kTick_ns);
  const AtlasPtr joined = joiner.subscriber->waitForAtlases(1).front();
  EXPECT_EQ(joined->timing, Timing::kCaptured);
  server.pipeline.drain();
  EXPECT_EQ(server.metrics.structures_built.value(), 1);
  EXPECT_EQ(tracedCount(server), 3) << "one each";
  EXPECT_THAT(viewer.subscriber->waitForAtlases(1), SizeIs(1));
  EXPECT_THAT(in_world.subscriber->waitForAtlases(1), SizeIs(1));
}

TEST_F(PipelineTicksTest, stopsWithACameraThatStandsFromNowOn) {
  Server server(device());
  const Viewer viewer = watch(server, ticking());
  const AtlasPtr second = begin(server, viewer);
  server.clock.advance(kFrame_ns);
  // The same frame, later: the camera has not moved.
  server.offer(frameAt(3, server.clock.nowNs(), second->source_camera.pose.position_m));
  AtlasPtr last = second;
  while (last->timing == Timing::kPredicted) last = next(server, viewer);
  EXPECT_EQ(last->timing, Timing::kCaptured);
  EXPECT_EQ(last->display_pose, second->source_camera.pose);
  EXPECT_EQ(last->frame_number, 2u);
  EXPECT_EQ(server.metrics.frames_unchanged.value(), 1);
}

TEST_F(PipelineTicksTest, showsWhatLiesBetweenTwoFramesByAskingBoth) {
  ASSERT_EQ(PipelineOptions{}.structure_slots_per_stream, 2u);
  Server server(device());
  DisplaySpec spec = ticking();
  spec.temporal->mode = TemporalMode::kInterpolate;
  const Viewer viewer = watch(server, spec);
  AtlasPtr atlas = begin(server, viewer);
  int between_count = 0;
  for (uint64_t number = 3; number <= 6; ++number) {
    server.clock.advance(kFrame_ns - kTick_ns);
    offerMoving(server, number);
    // A machine that is slow to trace may find the picture held already: then nothing more comes.
    for (int i = 0; i < kTicksMax && atlas->frame_number < number; ++i) {
      atlas = next(server, viewer);
    }
    if (atlas->timing == Timing::kCaptured) atlas = next(server, viewer);
    if (atlas->timing != Timing::kInterpolated) continue;
    ++between_count;
    const int64_t age_ns = atlas->capture_time_ns - atlas->shown_time_ns;
    EXPECT_GT(age_ns, 0);
    EXPECT_LT(glm::length(atlas->display_pose.position_m - placeAt(atlas->shown_time_ns)), 1e-9);
    EXPECT_EQ(atlas->method, TraceMethod::kWalk);
  }
  EXPECT_EQ(atlas->frame_number, 6u);
  EXPECT_GT(between_count, 0);
}

TEST_F(PipelineTicksTest, reportsAFrameThatNoTickSawAsReplaced) {
  Server server(device());
  const Viewer viewer = watch(server, ticking());
  begin(server, viewer);
  // No tick is due before the one after.
  for (const uint64_t number : {3, 4}) {
    server.clock.advance(kMs_ns);
    offerMoving(server, number);
    while (server.metrics.structures_built.value() < double(number)) std::this_thread::yield();
  }
  EXPECT_EQ(server.reports.waitForReports(3).back().outcome, FrameOutcome::kReplaced);
  next(server, viewer);
  const auto reports = server.reports.waitForReports(4);
  EXPECT_EQ(reports.back().number, 4u);
  EXPECT_EQ(reports.back().outcome, FrameOutcome::kTraced);
}

TEST_F(PipelineTicksTest, timesEachAtlasFromItsTickAndCountsTheTicksWithoutOne) {
  constexpr int64_t kLate_ns = 7 * kMs_ns;  // ticks are seen so late: between two of them
  constexpr int kAtlasCount = 4;
  constexpr int kMissedCount = 2;
  Server server(device());
  DisplaySpec spec = ticking();
  spec.temporal->bridge_s = 2;  // longer than the test needs: each tick shows something new
  const Viewer viewer = watch(server, spec);
  const auto metric = [&](const char* name) {
    return metricValue(server.metrics, strCat("viewloom_output_", name));
  };
  begin(server, viewer);
  server.clock.advance(kLate_ns);
  const int64_t begun_ns = server.clock.nowNs();
  const double count = metric("delay_seconds_count");
  const double skipped_count = metric("ticks_skipped_total");
  double sum_s = metric("delay_seconds_sum");
  for (int i = 1; i <= kAtlasCount; ++i) {
    const AtlasPtr atlas = next(server, viewer);
    ASSERT_EQ(atlas->timing, Timing::kPredicted);
    // Frames arrive at once, and what is predicted is shown at its tick.
    const int64_t delay_ns = server.clock.nowNs() - (atlas->shown_time_ns - kStart_ns);
    EXPECT_EQ(delay_ns % kTick_ns, kLate_ns);
    sum_s += 1e-9 * double(delay_ns);
    EXPECT_EQ(metric("delay_seconds_count"), count + i);
    EXPECT_NEAR(metric("delay_seconds_sum"), sum_s, 1e-9);
  }
  // If several ticks are due at once, only the newest can bring an atlas. The others are skipped.
  const double before_count = metric("ticks_skipped_total");
  server.clock.advance((kMissedCount + 1) * kTick_ns);
  const auto tick_count = double((server.clock.nowNs() - begun_ns) / kTick_ns);
  const auto seen_count = [&] {
    return metric("delay_seconds_count") - count + metric("ticks_skipped_total") - skipped_count;
  };
  for (int nap = 0; nap < 20000 && seen_count() < tick_count; ++nap) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(seen_count(), tick_count);
  EXPECT_GE(metric("ticks_skipped_total"), before_count + kMissedCount);
}

TEST_F(PipelineTicksTest, leavesDisplaysWithoutARateTheirFrames) {
  Server server(device());
  const Viewer viewer = watch(server, ticking());
  const Viewer other = watch(server, smallQuilt({64, 40}));
  for (uint64_t number = 1; number <= 3; ++number) {
    offerMoving(server, number);
    const AtlasPtr atlas = other.subscriber->waitForAtlases(number).back();
    EXPECT_EQ(atlas->frame_number, number);
    EXPECT_EQ(atlas->timing, Timing::kCaptured);
    server.clock.advance(kFrame_ns);
  }
  next(server, viewer);
  server.pipeline.drain();
  EXPECT_THAT(other.subscriber->waitForAtlases(3), SizeIs(3));
}

}  // namespace
}  // namespace viewloom::test::pipeline_ticks_test
