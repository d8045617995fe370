// SPDX-License-Identifier: Apache-2.0
#include "rpc/used_rate.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

namespace viewloom::used_rate_test {
namespace {

constexpr int64_t kSecond_ns = 1'000'000'000;

// A publisher that obeys, before a server that uses so many frames a second.
class Simulation {
 public:
  void run(double publisher_hz, double used_hz, int seconds) {
    const int64_t end_ns = now_ns_ + seconds * kSecond_ns;
    while (now_ns_ < end_ns) {
      const double limit_hz = rate_.limitHz();
      const double sent_hz = limit_hz > 0 && limit_hz < publisher_hz ? limit_hz : publisher_hz;
      now_ns_ += int64_t(1e9 / sent_hz);
      const bool is_used = double(now_ns_ - used_ns_) >= 0.999e9 / used_hz;
      if (is_used) used_ns_ = now_ns_;
      ++sent_count_;
      change_count_ += rate_.note(is_used, now_ns_);
    }
  }
  int sentCount() { return std::exchange(sent_count_, 0); }
  int changeCount() { return std::exchange(change_count_, 0); }
  UsedRate& rate() { return rate_; }

 private:
  UsedRate rate_;
  int64_t now_ns_ = kSecond_ns;
  int64_t used_ns_ = 0;
  int sent_count_ = 0;
  int change_count_ = 0;
};

TEST(UsedRate, limitsNobodyWhoseFramesAreUsed) {
  Simulation simulation;
  simulation.run(60, 1000, 30);
  EXPECT_EQ(simulation.rate().limitHz(), 0);
  EXPECT_EQ(simulation.changeCount(), 0);
}

TEST(UsedRate, isALittleMoreThanWhatIsUsed) {
  Simulation simulation;
  simulation.run(60, 8, 10);
  simulation.sentCount();
  simulation.changeCount();
  simulation.run(60, 8, 60);
  EXPECT_NEAR(simulation.sentCount() / 60.0, 8.5, 2);
  EXPECT_LE(simulation.changeCount(), 30);
}

// 10 Hz, of which a crowd leaves 1 Hz for a second.
TEST(UsedRate, isSoonGoneAfterAShortCrowd) {
  Simulation simulation;
  simulation.run(10, 1000, 10);
  simulation.run(10, 1, 1);
  simulation.sentCount();
  simulation.run(10, 1000, 10);
  EXPECT_GE(simulation.sentCount(), 80);
  EXPECT_EQ(simulation.rate().limitHz(), 0);
}

TEST(UsedRate, goesWhenThereIsTimeAgain) {
  Simulation simulation;
  simulation.run(30, 5, 20);
  EXPECT_GT(simulation.rate().limitHz(), 0);
  simulation.run(30, 1000, 60);
  EXPECT_EQ(simulation.rate().limitHz(), 0);
}

TEST(UsedRate, isForgotten) {
  Simulation simulation;
  simulation.run(30, 1, 20);
  EXPECT_NEAR(simulation.rate().limitHz(), 1.1, 0.4);
  simulation.rate().reset();
  EXPECT_EQ(simulation.rate().limitHz(), 0);
}

}  // namespace
}  // namespace viewloom::used_rate_test
