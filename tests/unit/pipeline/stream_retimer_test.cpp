// SPDX-License-Identifier: Apache-2.0
// The price of pictures between frames, and their end. An engine that only counts prepares them.
#include "pipeline/stream_retimer.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "unit/retime/moved_frames.h"

namespace viewloom::stream_retimer_test {
namespace {

constexpr int64_t kDevice_ns = 90'000'000;  // for one frame
constexpr double kTolerance = 0.05;         // 1/m

class CountedFrame final : public PreparedFrame {
 public:
  explicit CountedFrame(int& prepared_count) : prepared_count_(prepared_count) {}

  void take(FramePtr) override {}
  void reserve() override {}
  int64_t prepare(const Clock&, const PreparationEvents& events) override {
    ++prepared_count_;
    events.on_piece({.predicted_ns = kDevice_ns, .measured_ns = kDevice_ns});
    return 0;
  }
  FrameMeasures measures() const override { return {}; }

 private:
  int& prepared_count_;
};

class CountingPreparer final : public FramePreparer {
 public:
  explicit CountingPreparer(int& prepared_count) : prepared_count_(prepared_count) {}
  std::unique_ptr<PreparedFrame> make() override {
    return std::make_unique<CountedFrame>(prepared_count_);
  }

 private:
  int& prepared_count_;
};

class CountingEngine final : public Engine {
 public:
  explicit CountingEngine(int& prepared_count) : prepared_count_(prepared_count) {}

  TraceMethod method() const override { return TraceMethod::kWalk; }
  void connect(EngineEvents) override {}
  bool takes(const Frame&) const override { return true; }
  uint64_t preparedBytes(const FrameFormat&) const override { return 1; }
  std::unique_ptr<FramePreparer> preparer() override {
    return std::make_unique<CountingPreparer>(prepared_count_);
  }
  PlanPtr plan(const PicturePtr&, const PreparedFrame&) const override { return nullptr; }
  bool isReady(const AtlasOrder&, std::function<void()>) override { return true; }
  bool hasRoomForEyes(const std::string&) override { return false; }
  std::unique_ptr<Making> begin(AtlasOrder, HandOn) override { return nullptr; }
  std::optional<std::chrono::nanoseconds> workAhead() override { return std::nullopt; }
  void drain() override {}

 private:
  int& prepared_count_;
};

Engines countingEngines(int& prepared_count) {
  Engines engines;
  engines.all.push_back(std::make_unique<CountingEngine>(prepared_count));
  engines.workers = std::make_unique<WorkerPool>(2);
  return engines;
}

FramePtr frameThatMoves() {
  return test::movingFrame({[](uint32_t x, uint32_t y) {
                             return test::MovingPx{.inv_z = 0.5F,
                                                   .color = test::colorOfPx(x, y, 1),
                                                   .motion_mps = {1, 0, 0}};
                           }},
                           kTolerance);
}

class StreamRetimerTest : public testing::Test {
 protected:
  StreamRetimerTest() {
    for (const char* payer : {"viewer", "other"}) pay(payer, 10 * kCredit_ns);
  }
  void pay(const std::string& payer, int64_t time_ns) {
    shares_.begin(claimOfPayer(payer), time_ns);
    shares_.finish(claimOfPayer(payer), time_ns, time_ns);
  }
  static Claim claimOfPayer(const std::string& payer) {
    return {.payers = {Payer(payer)}, .stream = payer};
  }
  AtlasJob tickOf(int64_t carried_ns) const {
    auto structure = std::make_shared<ResidentStructure>();
    structure->stream = "scene";
    structure->serial = 1;
    structure->moving_frame = frameThatMoves();
    structure->retimer = retimer_;
    AtlasJob job{.structure = std::move(structure)};
    job.tick = OutputTick{.shown = {.carried_ns = carried_ns}};
    job.payers = {Payer("viewer")};
    return job;
  }

  int prepared_count_ = 0;
  const Engines engines_ = countingEngines(prepared_count_);
  SteadyClock clock_;
  Metrics metrics_;
  Broadcaster broadcaster_{{}};
  StreamDirectory directory_{clock_, 1};
  const PipelineLinks links_{.engines = engines_,
                             .clock = clock_,
                             .metrics = metrics_,
                             .broadcaster = broadcaster_,
                             .directory = directory_,
                             .on_failure = [](const std::exception&) {}};
  const FrameBuilder builder_{links_};
  const std::shared_ptr<StreamRetimer> retimer_ = std::make_shared<StreamRetimer>(links_, builder_);
  FairShares shares_;
  std::stop_source stop_;
};

TEST_F(StreamRetimerTest, isPaidByTheViewersOfTheTick) {
  AtlasJob job = tickOf(20'000'000);
  ASSERT_TRUE(showAsOfTick(job, shares_, stop_.get_token()));
  EXPECT_EQ(prepared_count_, 1);
  pay("other", kDevice_ns / 2);
  EXPECT_TRUE(shares_.goesBefore(claimOfPayer("other"), claimOfPayer("viewer")));
}

TEST_F(StreamRetimerTest, isPaidOnceForATimeThatSeveralShow) {
  for (int display = 0; display < 3; ++display) {
    AtlasJob job = tickOf(20'000'000);
    ASSERT_TRUE(showAsOfTick(job, shares_, stop_.get_token()));
  }
  EXPECT_EQ(prepared_count_, 1);
  pay("other", 2 * kDevice_ns);
  EXPECT_TRUE(shares_.goesBefore(claimOfPayer("viewer"), claimOfPayer("other")));
}

TEST_F(StreamRetimerTest, isGivenUpWhenTheServerStops) {
  stop_.request_stop();
  AtlasJob job = tickOf(20'000'000);
  EXPECT_FALSE(showAsOfTick(job, shares_, stop_.get_token()));
  EXPECT_EQ(prepared_count_, 0);
  EXPECT_EQ(metrics_.structures_retimed.value(), 0);
}

}  // namespace
}  // namespace viewloom::stream_retimer_test
