// SPDX-License-Identifier: Apache-2.0
// Which atlas goes first, and what a part that fails does to the rest.
#include <gmock/gmock.h>

#include <future>
#include <stdexcept>

#include "e2e/pipeline_fixture.h"
#include "e2e/slow_lens_engine.h"
#include "walk/walk_engine.h"

namespace viewloom::test::pipeline_order_test {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

// Notes under a name when its first atlas comes.
class OrderNoter final : public Subscriber {
 public:
  OrderNoter(std::string name, std::vector<std::string>& order, std::mutex& mutex)
      : name_(std::move(name)), order_(order), mutex_(mutex) {}

  void offer(AtlasPtr) override {
    {
      std::lock_guard lock(mutex_);
      order_.push_back(name_);
    }
    arrived_.set_value();
  }
  void end(const absl::Status&) override {}
  std::future<void> arrived() { return arrived_.get_future(); }

 private:
  const std::string name_;
  std::vector<std::string>& order_;
  std::mutex& mutex_;
  std::promise<void> arrived_;
};

// Holds the one encode thread in its first atlas until it is released.
class Gate final : public Subscriber {
 public:
  void offer(AtlasPtr) override {
    reached_.set_value();
    released_.get_future().wait();
  }
  void end(const absl::Status&) override {}
  void waitUntilReached() { reached_.get_future().wait(); }
  void release() { released_.set_value(); }

 private:
  std::promise<void> reached_;
  std::promise<void> released_;
};

class Thrower final : public Subscriber {
 public:
  void offer(AtlasPtr) override { throw std::runtime_error("out of paper"); }
  void end(const absl::Status&) override {}
};

class PipelineOrderTest : public PipelineFixture {
 protected:
  static std::unique_ptr<Broadcaster::Subscription> join(Server& server, const DisplaySpec& spec,
                                                         std::shared_ptr<Subscriber> subscriber) {
    return server.broadcaster.subscribe("scene", spec, {}, subscriber).value();
  }
};

TEST_F(PipelineOrderTest, letsASmallAtlasOvertakeALargeOneBetweenTwoStrips) {
  Server server(device(), {.encode_thread_count = 1, .trace_slot_count = 2});
  std::vector<std::string> order;
  std::mutex order_mutex;
  const auto gate = std::make_shared<Gate>();
  const auto large = std::make_shared<OrderNoter>("large", order, order_mutex);
  const auto small = std::make_shared<OrderNoter>("small", order, order_mutex);

  const auto gate_place = join(server, smallQuilt({64, 48}), gate);
  // So large that the small one is on its way before it is done, strip by strip or swept.
  const auto large_place = join(server, smallQuilt({2400, 4000}), large);
  server.offer(syntheticFrame(1));
  gate->waitUntilReached();
  // The large one has begun, and the small one waits. No later: what holds the encode thread in its
  // atlas holds up whoever is to begin another one.
  while (!server.broadcaster.layout(large_place->displayId())) std::this_thread::yield();
  const auto small_place = join(server, smallQuilt({80, 60}), small);
  gate->release();
  small->arrived().wait();
  large->arrived().wait();
  EXPECT_THAT(order, ElementsAre("small", "large"));
}

// By its deadline the lens would go first to its end. It has used more of the device by then than
// what comes late, whatever device it is.
TEST_F(PipelineOrderTest, letsAnAtlasByThatComesLateWhileALensTakesManyRays) {
  LensHold hold;
  ServerOptions options{.encode_thread_count = 1};
  options.make_engines = [&hold](const Device& device) {
    Engines engines{.all = {}, .workers = std::make_unique<WorkerPool>()};
    engines.all.push_back(std::make_unique<SlowLensEngine>(
        std::make_unique<WalkEngine>(device, WalkOptions{.strip_count_max = 2}), hold));
    return engines;
  };
  Server server(device(), options);
  std::vector<std::string> order;
  std::mutex order_mutex;
  const auto blurred = std::make_shared<OrderNoter>("blurred", order, order_mutex);
  const auto sharp = std::make_shared<OrderNoter>("sharp", order, order_mutex);

  DisplaySpec lens = smallQuilt({128, 64});
  lens.lens = LensSpec{.aperture_radius_m = 0.01,
                       .focus_distance_m = 2,
                       .walked_count = kWalkedSamplesMax,
                       .gathered_count = 0};
  const auto blurred_place = join(server, lens, blurred);
  server.offer(syntheticFrame(1));
  hold.waitUntilReached();
  constexpr int64_t kHour_ns = 3600'000'000'000;
  server.clock.advance(kHour_ns);  // whoever comes now is due later
  const auto sharp_place = join(server, turnedCamera(), sharp);
  hold.release();
  sharp->arrived().wait();
  blurred->arrived().wait();
  EXPECT_THAT(order, ElementsAre("sharp", "blurred"));
}

TEST_F(PipelineOrderTest, tellsOfAFailureOnceAndStillDrainsWithEveryFrameReported) {
  ManualClock clock;
  Metrics metrics;
  Broadcaster broadcaster({});
  StreamDirectory directory(clock, 1);
  ReportLog reports;
  std::promise<std::string> failure;
  {
    const Engines engines = makeEngines(device());
    Pipeline pipeline({.engines = engines,
                       .clock = clock,
                       .metrics = metrics,
                       .broadcaster = broadcaster,
                       .directory = directory,
                       .on_failure = [&](const std::exception& e) { failure.set_value(e.what()); }},
                      {.encode_thread_count = 1});
    const auto place =
        broadcaster.subscribe("scene", smallQuilt(), {}, std::make_shared<Thrower>()).value();
    pipeline.offerFrame({"scene", 1}, syntheticFrame(1), reports.recorder());
    EXPECT_EQ(failure.get_future().get(), "out of paper");
    pipeline.offerFrame({"scene", 1}, syntheticFrame(2), reports.recorder());
    pipeline.drain();
  }
  EXPECT_THAT(reports.waitForReports(2), SizeIs(2));
}

}  // namespace
}  // namespace viewloom::test::pipeline_order_test
