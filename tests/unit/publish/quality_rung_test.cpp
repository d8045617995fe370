// SPDX-License-Identifier: Apache-2.0
#include "publish/quality_rung.h"

#include <cmath>

#include <gtest/gtest.h>

namespace viewloom::test::quality_rung_test {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr double kFinestBytes = 100'000;
constexpr QualityRange kRange = {.finest_qp = 24, .coarsest_qp = 40, .bits_per_second_max = 0};

uint64_t bytesAt(uint32_t qp) {
  return uint64_t(kFinestBytes * std::pow(0.68, (double(qp) - 24) / 4));
}

// A rung of a display with 20 atlases a second.
class Display {
 public:
  explicit Display(const QualityRange& range = kRange) : rung_(range) {}

  // The quantisation after so long before a line of this speed.
  uint32_t run(int64_t duration_ms, std::optional<double> bytes_per_second) {
    for (const int64_t end_ns = now_ns_ + duration_ms * kMs; now_ns_ < end_ns;) {
      rung_.noteBegun(now_ns_);
      rung_.adapt(bytes_per_second, now_ns_);
      rung_.noteCoded(rung_.qp(), bytesAt(rung_.qp()));
      now_ns_ += 50 * kMs;
    }
    return rung_.qp();
  }

  LineFit fitOf(std::optional<double> bytes_per_second, uint64_t recent_bytes = 0) const {
    return rung_.fitOf({bytes_per_second, recent_bytes}, now_ns_ - 1);
  }

 private:
  QualityRung rung_;
  int64_t now_ns_ = 0;
};

TEST(QualityRungTest, staysAtTheFinestWhereNothingShowsALimit) {
  EXPECT_EQ(Display().run(3000, std::nullopt), 24u);
}

TEST(QualityRungTest, goesToTheFirstStepThatFits) {
  // The display takes 2 MB/s at the finest step, then 1.36, 0.92, 0.63, 0.43.
  EXPECT_EQ(Display().run(1500, 2.3e6), 24u);
  EXPECT_EQ(Display().run(1500, 1.6e6), 28u);
  EXPECT_EQ(Display().run(1500, 1.1e6), 32u);
  EXPECT_EQ(Display().run(1500, 1e5), 40u) << "and not beyond the coarsest";
}

TEST(QualityRungTest, coarsensAtOnceAndRefinesStepByStep) {
  Display display;
  EXPECT_EQ(display.run(2000, std::nullopt), 24u);
  EXPECT_EQ(display.run(50, 6e5), 40u);
  EXPECT_EQ(display.run(900, std::nullopt), 40u) << "not before a second";
  EXPECT_EQ(display.run(200, std::nullopt), 36u);
  EXPECT_EQ(display.run(3200, std::nullopt), 24u);
}

TEST(QualityRungTest, needsRoomForAFinerStep) {
  Display display;
  EXPECT_EQ(display.run(1500, 1.1e6), 32u);
  EXPECT_EQ(display.run(5000, 1.6e6), 32u) << "the finer step takes 1.36 MB/s";
  EXPECT_EQ(display.run(1500, 2.1e6), 28u);
}

TEST(QualityRungTest, waitsLongerAfterAStepThatWasTooFine) {
  Display display;
  display.run(1000, 1.1e6);
  int raise_count = 0;
  // The line shows its limit only when it is full.
  for (int i = 0; i < 40; ++i)
    raise_count += display.run(50, 1.1e6) == 32 && display.run(950, {}) == 28;
  EXPECT_LT(raise_count, 12);
  EXPECT_GT(raise_count, 1);
}

TEST(QualityRungTest, keepsToTheBitsThatReadersWant) {
  QualityRange range = kRange;
  range.bits_per_second_max = 8'000'000;
  EXPECT_EQ(Display(range).run(1500, std::nullopt), 32u);
  range.bits_per_second_max = 16'500'000;
  EXPECT_EQ(Display(range).run(1500, std::nullopt), 24u);
}

TEST(QualityRungTest, knowsWhichLinesItSuits) {
  Display display;
  EXPECT_EQ(display.fitOf(1e5), LineFit::kNear) << "no frames come";
  EXPECT_EQ(display.run(2000, std::nullopt), 24u);  // 2 MB/s
  EXPECT_EQ(display.fitOf(3e6), LineFit::kFits);
  EXPECT_EQ(display.fitOf(2.2e6), LineFit::kNear);
  EXPECT_EQ(display.fitOf(1.1e6), LineFit::kNear) << "it takes more than every other atlas";
  EXPECT_EQ(display.fitOf(0.9e6), LineFit::kFar);
  EXPECT_EQ(display.fitOf(std::nullopt, 1'500'000), LineFit::kFits) << "it had the next step";
  EXPECT_EQ(display.fitOf(std::nullopt, 1'000'000), LineFit::kUnknown);
}

TEST(QualityRungTest, callsNoLineFarWhereNothingCoarserWouldHelp) {
  Display display;
  EXPECT_EQ(display.run(2000, 1.1e6), 32u);
  EXPECT_EQ(display.fitOf(3e5), LineFit::kFar);
  EXPECT_EQ(display.run(2000, 7.5e5), 36u);
  EXPECT_EQ(display.fitOf(2e5), LineFit::kNear) << "one step is left, and no more";
}

TEST(QualityRungTest, endsAtTheCoarsestBetweenTwoSteps) {
  Display display({.finest_qp = 24, .coarsest_qp = 30, .bits_per_second_max = 0});
  EXPECT_EQ(display.run(1500, 1e5), 30u);
}

}  // namespace
}  // namespace viewloom::test::quality_rung_test
