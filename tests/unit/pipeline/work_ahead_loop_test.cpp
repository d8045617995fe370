// SPDX-License-Identifier: Apache-2.0
// An engine works ahead while it has nothing to do, and is asked again after each pause.
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <utility>

#include "pipeline/pipeline.h"
#include "unit/pipeline/no_engine.h"

namespace viewloom::work_ahead_loop_test {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPause{30};
constexpr int kPauses = 2;

// Has to rest twice before it does its one piece of work; then there is no more.
class RestingEngine final : public test::NoEngine {
 public:
  explicit RestingEngine(std::promise<void> done) : done_(std::move(done)) {}

  std::optional<std::chrono::nanoseconds> workAhead() override {
    ++asked_count_;
    if (asked_count_ <= kPauses) return kPause;
    if (asked_count_ == kPauses + 1) return std::chrono::nanoseconds(0);
    if (asked_count_ == kPauses + 2) done_.set_value();
    return std::nullopt;
  }

 private:
  std::promise<void> done_;
  int asked_count_ = 0;  // the thread's of the loop
};

TEST(WorkAheadLoop, asksAnEngineAgainAfterItsPause) {
  std::promise<void> done;
  std::future<void> is_done = done.get_future();
  Engines engines{.all = {}, .workers = std::make_unique<WorkerPool>()};
  engines.all.push_back(std::make_unique<RestingEngine>(std::move(done)));
  const SteadyClock clock;
  Metrics metrics;
  Broadcaster broadcaster{{}};
  StreamDirectory directory{clock, 16};
  const auto begun = steady_clock::now();
  Pipeline pipeline(
      {.engines = engines,
       .clock = clock,
       .metrics = metrics,
       .broadcaster = broadcaster,
       .directory = directory,
       .on_failure = [](const std::exception& error) { ADD_FAILURE() << error.what(); }},
      {});
  ASSERT_EQ(is_done.wait_for(std::chrono::seconds(10)), std::future_status::ready)
      << "the loop sleeps";
  EXPECT_GE(steady_clock::now() - begun, kPauses * kPause);
}

}  // namespace
}  // namespace viewloom::work_ahead_loop_test
