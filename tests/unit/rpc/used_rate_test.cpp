// SPDX-License-Identifier: Apache-2.0
#include "rpc/used_rate.h"

#include <gtest/gtest.h>

#include <algorithm>
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

// A publisher that obeys, before a server that makes it wait until its frames have their turns. Of
// its frames, some may be on their way.
class HeldBack {
 public:
  void run(double publisher_hz, double used_hz, int seconds) {
    const int64_t end_ns = now_ns_ + seconds * kSecond_ns;
    while (now_ns_ < end_ns) {
      const double limit_hz = rate_.limitHz();
      const double sent_hz = limit_hz > 0 && limit_hz < publisher_hz ? limit_hz : publisher_hz;
      const int64_t made_ns = std::max(made_ns_ + int64_t(1e9 / sent_hz), now_ns_ - kOldest_ns);
      const int64_t received_ns = std::max(made_ns, now_ns_);  // after the one before is taken
      const int64_t taken_ns = std::max(received_ns, now_ns_ + int64_t(1e9 / used_hz));
      made_ns_ = made_ns;
      now_ns_ = taken_ns;
      oldest_ns_ = std::max(oldest_ns_, taken_ns - made_ns);
      ++taken_count_;
      if (knows_turns) rate_.noteTurn(taken_ns - received_ns, now_ns_);
      rate_.note(true, now_ns_);
    }
  }
  int takenCount() { return std::exchange(taken_count_, 0); }
  int64_t oldestNs() { return std::exchange(oldest_ns_, 0); }
  UsedRate& rate() { return rate_; }

  bool knows_turns = true;

 private:
  // Frames on their way are no older; beyond that the publisher itself replaces frames.
  static constexpr int64_t kOldest_ns = 2 * kSecond_ns;

  UsedRate rate_;
  int64_t now_ns_ = 10 * kSecond_ns;
  int64_t made_ns_ = 10 * kSecond_ns;
  int64_t oldest_ns_ = 0;
  int taken_count_ = 0;
};

TEST(UsedRate, knowsNothingOfPublishersThatAreHeldBackButByTurns) {
  HeldBack publisher;
  publisher.knows_turns = false;
  publisher.run(10, 4, 60);
  EXPECT_EQ(publisher.rate().limitHz(), 0);
  EXPECT_GE(publisher.oldestNs(), 2 * kSecond_ns);
}

TEST(UsedRate, keepsFramesFreshThatWouldWaitForTheirTurns) {
  HeldBack publisher;
  publisher.run(10, 4, 20);
  publisher.oldestNs();
  publisher.takenCount();
  publisher.run(10, 4, 60);
  EXPECT_LT(publisher.oldestNs(), 3 * kSecond_ns / 4);
  EXPECT_GE(publisher.takenCount(), 0.85 * 4 * 60) << "and the server is used";
}

TEST(UsedRate, isAboutOneWhereAFrameASecondIsTaken) {
  HeldBack publisher;
  publisher.run(30, 1, 10);
  EXPECT_NEAR(publisher.rate().limitHz(), 1, 0.3);
}

// Turns so rare that no three of them come within seconds.
TEST(UsedRate, keepsFramesFreshWhereTurnsAreRare) {
  constexpr double kTurns_hz = 0.25;
  HeldBack publisher;
  publisher.run(10, kTurns_hz, 60);
  EXPECT_NEAR(publisher.rate().limitHz(), kTurns_hz, 0.15) << "and a little more is tried";
  publisher.oldestNs();
  publisher.takenCount();
  publisher.run(10, kTurns_hz, 240);
  EXPECT_LT(publisher.oldestNs(), 5 * kSecond_ns) << "a turn is 4 s";
  EXPECT_GE(publisher.takenCount(), 0.8 * kTurns_hz * 240) << "and the server is used";
}

TEST(UsedRate, goesWhenRareTurnsComeSooner) {
  HeldBack publisher;
  publisher.run(10, 0.15, 60);
  EXPECT_GT(publisher.rate().limitHz(), 0);
  publisher.run(10, 1000, 60);
  EXPECT_EQ(publisher.rate().limitHz(), 0);
}

TEST(UsedRate, asksForAFrameInTenSecondsAtLeast) {
  HeldBack publisher;
  publisher.run(10, 0.02, 600);
  EXPECT_NEAR(publisher.rate().limitHz(), 0.1, 0.01);
}

TEST(UsedRate, leavesPublishersAloneWhoseFramesWaitForAWhile) {
  HeldBack publisher;
  publisher.run(10, 11, 30);
  EXPECT_EQ(publisher.rate().limitHz(), 0);
}

TEST(UsedRate, goesWhenTurnsComeSooner) {
  HeldBack publisher;
  publisher.run(10, 2, 20);
  EXPECT_GT(publisher.rate().limitHz(), 0);
  publisher.run(10, 1000, 30);
  EXPECT_EQ(publisher.rate().limitHz(), 0);
}

// Kernels of a new display are compiled meanwhile.
TEST(UsedRate, isSoonGoneAfterAFewLongTurns) {
  HeldBack publisher;
  publisher.run(15, 1, 4);
  EXPECT_LE(publisher.rate().limitHz(), 1);
  EXPECT_GT(publisher.rate().limitHz(), 0);
  publisher.run(15, 1000, 3);
  publisher.takenCount();
  publisher.run(15, 1000, 2);
  EXPECT_GE(publisher.takenCount(), 28);
  publisher.run(15, 1000, 3);
  EXPECT_EQ(publisher.rate().limitHz(), 0);
}

TEST(UsedRate, isSoonGoneAfterAFewVeryLongTurns) {
  HeldBack publisher;
  publisher.run(15, 0.4, 8);
  EXPECT_LE(publisher.rate().limitHz(), 0.5);
  EXPECT_GT(publisher.rate().limitHz(), 0);
  publisher.run(15, 1000, 5);
  publisher.takenCount();
  publisher.run(15, 1000, 2);
  EXPECT_GE(publisher.takenCount(), 28);
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
