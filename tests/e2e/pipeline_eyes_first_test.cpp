// SPDX-License-Identifier: Apache-2.0
// Priority of tracked eyes: the newest poses are rendered, before all other work.
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "e2e/gate_clock.h"
#include "e2e/pipeline_fixture.h"
#include "schedule/moving_heads.h"

namespace viewloom::test::pipeline_eyes_first_test {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

constexpr int64_t kMs_ns = 1'000'000;
constexpr int64_t kHour_ns = 3'600'000 * kMs_ns;

DisplaySpec trackedEyes() {
  return *completeDisplaySpec(
      {.kind = StereoSpec{.eye_size_px = {64, 48}, .focal_distance_m = 4, .is_tracked = true}});
}

EyePoses eyesAt(double x_m, int64_t received_ns) {
  EyePoses poses;
  poses.received_ns = received_ns;
  poses.eyes[0].pose.position_m.x = x_m;
  poses.eyes[1].pose.position_m.x = x_m + 0.06;
  return poses;
}

// Reports the arrival of its first atlas, and the thread. One thread packs all atlases.
class FirstAtlas final : public Subscriber {
 public:
  FirstAtlas(std::string name, std::vector<std::string>& log) : name_(std::move(name)), log_(log) {}

  void offer(AtlasPtr atlas) override {
    if (atlas->sequence != 1) return;
    log_.push_back(name_);
    came_.set_value(std::this_thread::get_id());
  }
  void end(const absl::Status& status) override { ADD_FAILURE() << status; }

  std::thread::id wait() { return came_.get_future().get(); }

 private:
  const std::string name_;
  std::vector<std::string>& log_;
  std::promise<std::thread::id> came_;
};

class PipelineEyesFirstTest : public PipelineFixture {
 protected:
  // Blocks the only packing thread within the first atlas of this display.
  void holdWithin(const DisplaySpec& spec, EyeTrackPtr eyes, uint32_t slot_count) {
    server_ = std::make_unique<Server>(
        device(), ServerOptions{.encode_thread_count = 1, .trace_slot_count = slot_count}, &clock_);
    server_->offer(syntheticFrame(1));
    const auto first = std::make_shared<FirstAtlas>("first", log_);
    waitUntilBegun(subscribe(smallQuilt({64, 40}), first));
    clock_.hold(first->wait());
    waitUntilBegun(subscribe(spec, held_, std::move(eyes)));
    clock_.waitUntilHeld();
  }

  uint64_t subscribe(const DisplaySpec& spec, const std::shared_ptr<Subscriber>& subscriber,
                     EyeTrackPtr eyes = nullptr) {
    auto subscription =
        server_->broadcaster.subscribe("scene", spec, {}, subscriber, std::move(eyes));
    subscriptions_.push_back(*std::move(subscription));
    return subscriptions_.back()->displayId();
  }

  // Returns when the first atlas of a display has begun.
  void waitUntilBegun(uint64_t display_id) {
    while (server_->broadcaster.layout(display_id) == nullptr) std::this_thread::yield();
  }

  GateClock clock_;
  std::vector<std::string> log_;
  const std::shared_ptr<FirstAtlas> held_ = std::make_shared<FirstAtlas>("held", log_);
  std::unique_ptr<Server> server_;
  std::vector<std::unique_ptr<Broadcaster::Subscription>> subscriptions_;
};

TEST_F(PipelineEyesFirstTest, takesTheEyesAsTheyAreWhenThereIsRoomForTheirRays) {
  holdWithin(trackedEyes(), std::make_shared<EyeTrack>(), 1);  // in the room that there is
  const auto eyes = std::make_shared<EyeTrack>();
  const auto subscriber = std::make_shared<CollectingSubscriber>();
  eyes->put(eyesAt(0.1, clock_.nowNs()));
  const uint64_t tracked_id = subscribe(trackedEyes(), subscriber, eyes);
  clock_.advance(7);
  eyes->put(eyesAt(0.2, clock_.nowNs()));
  server_->pipeline.serveEyes(tracked_id);
  clock_.advance(30);
  clock_.letGo();
  const auto atlases = subscriber->waitForAtlases(1);
  ASSERT_THAT(atlases, SizeIs(1));
  EXPECT_EQ(atlases[0]->layout->views[0].camera.pose.position_m.x, 0.2);
  EXPECT_EQ(atlases[0]->eye_poses_latched_ns, clock_.nowNs());
  EXPECT_EQ(atlases[0]->eye_poses_age_ns, 30);
  server_->pipeline.drain();
  EXPECT_EQ(server_->broadcaster.atlasCount(tracked_id), 1u) << "nothing is left to show";
}

// One slot is the quilt's; eyes have their own.
TEST_F(PipelineEyesFirstTest, servesEyesBeforeTheRestOfAQuiltThatIsLongOverdue) {
  holdWithin(smallQuilt({320, 1200}), nullptr, 1);
  clock_.advance(kHour_ns);
  const auto eyes = std::make_shared<FirstAtlas>("eyes", log_);
  waitUntilBegun(subscribe(trackedEyes(), eyes, std::make_shared<EyeTrack>()));
  clock_.letGo();
  eyes->wait();
  held_->wait();
  EXPECT_THAT(log_, ElementsAre("first", "eyes", "held"));
}

// Eyes that move every 10 ms, and could not be served for most of the last of them.
class PipelineAgedEyesTest : public PipelineFixture {
 protected:
  void SetUp() override {
    PipelineFixture::SetUp();
    if (IsSkipped()) return;
    server_ = std::make_unique<Server>(device());
    server_->offer(syntheticFrame(1));
    auto subscription =
        server_->broadcaster.subscribe("scene", trackedEyes(), {}, subscriber_, eyes_);
    subscription_ = *std::move(subscription);
    ASSERT_THAT(subscriber_->waitForAtlases(1), SizeIs(1));
    server_->clock.advance(100 * kMs_ns);
    moveTo(0.1);
    ASSERT_THAT(subscriber_->waitForAtlases(2), SizeIs(2));
    server_->clock.advance(10 * kMs_ns);
    const int64_t moved_ns = server_->clock.nowNs();
    server_->clock.advance(8 * kMs_ns);
    moveTo(0.2, moved_ns);
    // Time for who does not wait to begin.
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }

  void moveTo(double x_m, int64_t received_ns) {
    eyes_->put(eyesAt(x_m, received_ns));
    server_->pipeline.serveEyes(subscription_->displayId());
  }
  void moveTo(double x_m) { moveTo(x_m, server_->clock.nowNs()); }

  // The third atlas has come, and shows what they see from there.
  void expectThird(double x_m, int64_t age_ns) {
    const auto atlases = subscriber_->waitForAtlases(3);
    ASSERT_THAT(atlases, SizeIs(3));
    EXPECT_EQ(atlases[2]->layout->views[0].camera.pose.position_m.x, x_m);
    EXPECT_EQ(atlases[2]->eye_poses_age_ns, age_ns);
  }

  const EyeTrackPtr eyes_ = std::make_shared<EyeTrack>();
  const std::shared_ptr<CollectingSubscriber> subscriber_ =
      std::make_shared<CollectingSubscriber>();
  std::unique_ptr<Server> server_;
  std::unique_ptr<Broadcaster::Subscription> subscription_;
};

TEST_F(PipelineAgedEyesTest, waitForPosesThatAreDue) {
  server_->clock.advance(1 * kMs_ns);
  moveTo(0.3);
  expectThird(0.3, 0);
}

TEST_F(PipelineAgedEyesTest, doNotWaitForThemForEver) {
  server_->clock.advance(2 * kMs_ns + kAlikePoses_ns);
  expectThird(0.2, 10 * kMs_ns + kAlikePoses_ns);
}

}  // namespace
}  // namespace viewloom::test::pipeline_eyes_first_test
