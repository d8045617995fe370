// SPDX-License-Identifier: Apache-2.0
// While things are carried on to a time between frames: who goes on, and who ends.
#include <chrono>
#include <future>
#include <memory>
#include <thread>
#include <utility>

#include <gmock/gmock.h>

#include "e2e/gate_clock.h"
#include "e2e/ticks_fixture.h"

namespace viewloom::test::pipeline_retiming_test {
namespace {

using testing::SizeIs;

constexpr SizePx kSmall_px{160, 90};
constexpr uint16_t kOneMps = 0x3C00;  // binary16

class PipelineRetimingTest : public TicksFixture {
 protected:
  // Captured now, from a place of the number.
  FramePtr frame(uint64_t number) const {
    auto seen = std::make_shared<Frame>(*movedFrame(*syntheticFrame(1, kSmall_px), number));
    const int64_t now_ns = clock_.nowNs();
    seen->format.capture_time_ns = kStart_ns + now_ns;
    seen->times = {now_ns, now_ns, now_ns};
    return seen;
  }
  // All of it goes to the right.
  FramePtr movingFrame(uint64_t number) const {
    auto moving = std::make_shared<Frame>(*frame(number));
    std::vector<uint8_t> motion(kSmall_px.area() * 6);
    for (size_t px = 0; px < kSmall_px.area(); ++px) motion[6 * px + 1] = kOneMps >> 8;
    const auto plane = std::make_shared<const std::vector<uint8_t>>(std::move(motion));
    for (LayerPlanes& layer : moving->sources.front()) layer.motion = plane;
    return moving;
  }

  // Else a test that fails would wait for who is held.
  void TearDown() override {
    clock_.letGo();
    TicksFixture::TearDown();
  }

  // A display of things that move has had its first atlas, and its next is being made.
  void holdWithinRetiming() {
    moving_ = watch(server_, ticking());
    server_.offer(movingFrame(1));
    ASSERT_THAT(moving_.subscriber->waitForAtlases(1), SizeIs(1));
    // Ticks are skipped until the first atlas is off the loops.
    bool is_held = false;
    for (; held_tick_ < kTicksMax && !is_held; ++held_tick_) {
      clock_.holdNext("retime");
      clock_.advance(kTick_ns);
      is_held = clock_.waitUntilHeld(std::chrono::milliseconds(300));
    }
    ASSERT_TRUE(is_held);
    ASSERT_EQ(server_.metrics.structures_retimed.value(), 0) << "made on the thread of the ticks";
  }

  // Ticks until the display has such an atlas; false when none is to be expected any more.
  template <typename IsWanted>
  bool tickUntil(const Viewer& viewer, const IsWanted& isWanted) {
    const auto has = [&] {
      const AtlasPtr newest = server_.broadcaster.newest(viewer.subscription->displayId());
      return newest && isWanted(*newest);
    };
    for (int tick = 0; tick < kTicksMax && !has(); ++tick) {
      clock_.advance(kTick_ns);
      for (int nap = 0; nap < 300 && !has(); ++nap) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
    return has();
  }

  GateClock clock_;
  Server server_{device(), {}, &clock_};
  Viewer moving_;
  int held_tick_ = 0;  // by which the next atlas is being made
};

TEST_F(PipelineRetimingTest, letsTheTicksOfOthersGoOnMeanwhile) {
  const Viewer other = watch(server_, ticking(), {}, "other");
  server_.offer(frame(1), "other");
  ASSERT_THAT(other.subscriber->waitForAtlases(1), SizeIs(1));
  holdWithinRetiming();
  if (HasFatalFailure()) return;
  server_.offer(frame(2), "other");
  EXPECT_TRUE(tickUntil(other, [](const EncodedAtlas& atlas) {
    return atlas.frame_number == 2 && atlas.timing == Timing::kPredicted;
  })) << "its camera goes on";
  EXPECT_EQ(server_.broadcaster.atlasCount(moving_.subscription->displayId()), 1u);
  EXPECT_GT(server_.metrics.output_ticks_skipped.value(), 0) << "of what is being made";
  clock_.letGo();
  const auto atlases = moving_.subscriber->waitForAtlases(2);
  ASSERT_THAT(atlases, SizeIs(2));
  EXPECT_EQ(atlases[1]->timing, Timing::kPredicted);
  EXPECT_LE(atlases[1]->shown_time_ns, atlases[1]->capture_time_ns + held_tick_ * kTick_ns)
      << "the tick that was taken";
}

TEST_F(PipelineRetimingTest, tellsHowLongItTook) {
  holdWithinRetiming();
  if (HasFatalFailure()) return;
  clock_.passAtEachQuestion(1);
  clock_.letGo();
  const auto atlases = moving_.subscriber->waitForAtlases(2);
  ASSERT_THAT(atlases, SizeIs(2));
  EXPECT_EQ(atlases[0]->times.retime_ns, 0) << "as the frame came";
  EXPECT_GT(atlases[1]->times.retime_ns, 0);
}

TEST_F(PipelineRetimingTest, givesItUpWhenItIsDrained) {
  holdWithinRetiming();
  if (HasFatalFailure()) return;
  server_.offer(movingFrame(2));
  while (server_.metrics.structures_built.value() < 2) std::this_thread::yield();
  auto drained = std::async(std::launch::async, [this] { server_.pipeline.drain(); });
  EXPECT_EQ(drained.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  clock_.letGo();
  drained.wait();
  EXPECT_EQ(server_.metrics.structures_retimed.value(), 0);
  EXPECT_THAT(server_.reports.waitForReports(2), SizeIs(2)) << "also of the frame nobody saw";
}

TEST_F(PipelineRetimingTest, outlivesItsStreamAndTheDisplay) {
  holdWithinRetiming();
  if (HasFatalFailure()) return;
  moving_.subscription.reset();
  server_.pipeline.forgetStream("scene");
  clock_.letGo();
  while (server_.metrics.structures_retimed.value() < 1) std::this_thread::yield();
  // A new stream of that name begins anew.
  const Viewer again = watch(server_, ticking());
  server_.offer(movingFrame(7));
  EXPECT_TRUE(tickUntil(again, [](const EncodedAtlas& atlas) {
    return atlas.frame_number == 7 && atlas.timing == Timing::kPredicted;
  }));
}

}  // namespace
}  // namespace viewloom::test::pipeline_retiming_test
