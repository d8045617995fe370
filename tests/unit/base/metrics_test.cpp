// SPDX-License-Identifier: Apache-2.0
#include "metrics/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "base/str_cat.h"
#include "metrics/client_seconds.h"

namespace viewloom::metrics_test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
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

TEST(Metrics, namesClientsThatProveWhoTheyAre) {
  const Metrics metrics(ClientNames::kShown);
  const Payer anna("anna"), bert("bert");
  metrics.observePiece(EngineWork::kTrace, {anna, bert}, {.measured_ns = 2'000'000'000});
  metrics.observePiece(EngineWork::kPack, {bert}, {.measured_ns = 500'000'000});
  metrics.observePiece(EngineWork::kBuild, {Payer()}, {.measured_ns = 500'000'000});
  const std::string text = metrics.text();
  EXPECT_THAT(text, HasSubstr("viewloom_client_engine_seconds_total{client=\"anna\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("viewloom_client_engine_seconds_total{client=\"bert\"} 1.5\n"));
  EXPECT_THAT(text, HasSubstr("viewloom_engine_seconds_total{payer=\"server\"} 0.5\n"));
}

TEST(Metrics, namesNobodyWhereAddressesAreNames) {
  const Metrics metrics;
  metrics.observePiece(EngineWork::kTrace, {Payer("192.0.2.7")}, {.measured_ns = 1'000'000});
  EXPECT_THAT(metrics.text(), Not(HasSubstr("192.0.2.7")));
}

TEST(Metrics, namesAFewHundredClients) {
  const Metrics metrics(ClientNames::kShown);
  for (size_t i = 0; i < ClientSeconds::kNamedClients + 3; ++i) {
    metrics.observePiece(EngineWork::kTrace, {Payer(strCat("client-", i))},
                         {.measured_ns = 1'000'000'000});
  }
  const std::string text = metrics.text();
  EXPECT_THAT(text, HasSubstr("{client=\"client-255\"} 1\n"));
  EXPECT_THAT(text, Not(HasSubstr("client-256")));
  EXPECT_THAT(text, HasSubstr("{client=\"others\"} 3\n"));
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
