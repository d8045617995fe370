// SPDX-License-Identifier: Apache-2.0
#include "metrics/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <thread>
#include <vector>

namespace viewloom::metrics_test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Value;

TEST(Metrics, showsWhatWasCounted) {
  Metrics metrics;
  metrics.frames_received.add(3);
  metrics.replaced[HandOver::kTrace].add();
  metrics.subscribers[Transport::kWeb].add(2);
  metrics.subscribers[Transport::kWeb].add(-1);
  const std::string text = metrics.text();
  EXPECT_THAT(text, HasSubstr("viewloom_frames_received_total 3"));
  EXPECT_THAT(text, HasSubstr("viewloom_replaced_total{hand_over=\"trace\"} 1"));
  EXPECT_THAT(text, HasSubstr("viewloom_subscribers{transport=\"web\"} 1"));
}

TEST(Metrics, timesStagesInSeconds) {
  Metrics metrics;
  metrics.observeStage(Stage::kTrace, 1'500'000'000);
  const std::string text = metrics.text();
  EXPECT_THAT(text, HasSubstr("viewloom_stage_seconds_sum{stage=\"trace\"} 1.5"));
  EXPECT_THAT(text, HasSubstr("viewloom_stage_seconds_count{stage=\"trace\"} 1"));
  EXPECT_THAT(text, HasSubstr("viewloom_stage_seconds_bucket{stage=\"trace\",le=\"1\"} 0"));
  EXPECT_THAT(text, HasSubstr("viewloom_stage_seconds_bucket{stage=\"trace\",le=\"2\"} 1"));
}

// The grammar of Prometheus' text format 0.0.4, written out independently of the serialiser.
TEST(Metrics, writesOnlyLinesThatPrometheusReads) {
  Metrics metrics;
  const auto comment = MatchesRegex(R"(# (HELP|TYPE) viewloom_[a-z_]+ .+)");
  const auto sample =
      MatchesRegex(R"(viewloom_[a-z_]+(\{[a-z_]+="[^"]*"(,[a-z_]+="[^"]*")*\})? -?[0-9.e+-]+)");
  std::istringstream lines(metrics.text());
  size_t sample_count = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_THAT(line, AnyOf(sample, comment));
    sample_count += Value(line, sample);
  }
  EXPECT_GT(sample_count, 0u);
}

TEST(Metrics, losesNoCountAmongThreads) {
  Metrics metrics;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&metrics] {
      for (int i = 0; i < 10'000; ++i) metrics.bands_encoded.add();
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(metrics.bands_encoded.value(), 40'000);
}

}  // namespace
}  // namespace viewloom::metrics_test
