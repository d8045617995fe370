// SPDX-License-Identifier: Apache-2.0
// When a tracked display is traced: by the newest eyes, one atlas after the other.
#include <future>
#include <thread>

#include <gmock/gmock.h>

#include "e2e/pipeline_fixture.h"

namespace viewloom::test::pipeline_eyes_test {
namespace {

using testing::SizeIs;

DisplaySpec trackedEyes() {
  return *completeDisplaySpec(
      {.kind = StereoSpec{.eye_size_px = {64, 48}, .focal_distance_m = 4, .is_tracked = true}});
}

EyePoses eyesAt(double x_m) {
  EyePoses poses;
  poses.eyes[0].pose.position_m.x = x_m;
  poses.eyes[1].pose.position_m.x = x_m + 0.06;
  return poses;
}

// Takes its first atlas, and returns when it is told to.
class SlowSubscriber final : public Subscriber {
 public:
  void offer(AtlasPtr atlas) override {
    if (atlas->sequence != 1) return;
    is_offered.set_value();
    may_return.get_future().wait();
  }
  void end(const absl::Status& status) override { ADD_FAILURE() << status; }

  std::promise<void> is_offered;
  std::promise<void> may_return;
};

class PipelineEyesTest : public PipelineFixture {
 protected:
  // Position x of the left eye in the newest layout, m.
  static double eyeOf(const Server& server, uint64_t display_id) {
    return server.broadcaster.layout(display_id)->views[0].camera.pose.position_m.x;
  }
};

TEST_F(PipelineEyesTest, beginsNoAtlasBeforeTheLastOneOfTheDisplayIsOut) {
  Server server(device());
  const auto slow = std::make_shared<SlowSubscriber>();
  const auto eyes = std::make_shared<EyeTrack>();
  const auto subscription = *server.broadcaster.subscribe("scene", trackedEyes(), {}, slow, eyes);
  const uint64_t tracked_id = subscription->displayId();
  server.offer(syntheticFrame(1));
  slow->is_offered.get_future().wait();
  for (const double x_m : {0.1, 0.2, 0.3}) {
    eyes->put(eyesAt(x_m));
    server.pipeline.serveEyes(tracked_id);
  }
  // It is due later, and begins.
  const Viewer other = watch(server, smallQuilt());
  const uint64_t other_id = other.subscription->displayId();
  while (server.broadcaster.layout(other_id) == nullptr && eyeOf(server, tracked_id) < 0) {
    std::this_thread::yield();
  }
  EXPECT_LT(eyeOf(server, tracked_id), 0) << "the eyes that stood in";
  slow->may_return.set_value();
  ASSERT_THAT(other.subscriber->waitForAtlases(1), SizeIs(1));
  while (server.broadcaster.atlasCount(tracked_id) < 2) std::this_thread::yield();
  EXPECT_EQ(eyeOf(server, tracked_id), 0.3);
  server.pipeline.drain();
  EXPECT_EQ(server.broadcaster.atlasCount(tracked_id), 2u) << "those between were overtaken";
}

TEST_F(PipelineEyesTest, neverTurnsADisplayBackToAnOlderFrame) {
  Server server(device());
  const auto eyes = std::make_shared<EyeTrack>();
  const auto subscriber = std::make_shared<CollectingSubscriber>();
  const auto subscription =
      *server.broadcaster.subscribe("scene", trackedEyes(), {}, subscriber, eyes);
  std::jthread flood([&](const std::stop_token& stop) {
    for (double x_m = 0; !stop.stop_requested(); x_m += 1e-4) {
      eyes->put(eyesAt(x_m));
      server.pipeline.serveEyes(subscription->displayId());
    }
  });
  constexpr uint64_t kFrameCount = 12;
  for (uint64_t number = 1; number <= kFrameCount; ++number) {
    server.offer(syntheticFrame(number, {160, 90}, 2, 0.1 * double(number)));
    const auto reports = server.reports.waitForReports(number);
    ASSERT_THAT(reports, SizeIs(number));
    EXPECT_EQ(reports.back().outcome, FrameOutcome::kTraced) << number;
  }
  flood.request_stop();
  flood.join();
  server.pipeline.drain();
  uint64_t frame_number = 0;
  double x_m = -1;
  for (const AtlasPtr& atlas : subscriber->waitForAtlases(kFrameCount)) {
    EXPECT_GE(atlas->frame_number, frame_number);
    EXPECT_GE(atlas->layout->views[0].camera.pose.position_m.x, x_m);
    frame_number = atlas->frame_number;
    x_m = atlas->layout->views[0].camera.pose.position_m.x;
  }
  EXPECT_EQ(frame_number, kFrameCount);
}

}  // namespace
}  // namespace viewloom::test::pipeline_eyes_test
