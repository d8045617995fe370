// SPDX-License-Identifier: Apache-2.0
#include "admission/memory_budget.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "base/retry_delay.h"

namespace viewloom::memory_budget_test {
namespace {

MemoryRequest of(const std::string& identity, uint64_t bytes, MemoryUse use = MemoryUse::kFrames) {
  return {.use = use, .identity = identity, .bytes = bytes};
}

class Shelf final : public IdleMemory {
 public:
  explicit Shelf(uint64_t bytes) : bytes_(bytes) {}
  uint64_t idleBytes() const override { return bytes_; }
  uint64_t releaseIdle(std::chrono::nanoseconds unused_for) override {
    last_unused_for = unused_for;
    return bytes_.exchange(0);
  }

  std::chrono::nanoseconds last_unused_for{-1};

 private:
  std::atomic<uint64_t> bytes_;
};

TEST(MemoryBudget, givesBackWhatAReservationHeld) {
  MemoryBudget budget(1000);
  {
    const auto held = budget.tryReserve(of("", 600));
    ASSERT_TRUE(held);
    EXPECT_EQ(budget.reservedBytes(), 600u);
    EXPECT_EQ(budget.reservedBytes(MemoryUse::kFrames), 600u);
    EXPECT_FALSE(budget.tryReserve(of("", 401)));
    EXPECT_TRUE(budget.tryReserve(of("", 400)));
  }
  EXPECT_EQ(budget.reservedBytes(), 0u);
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kFrames), 0u);
}

TEST(MemoryBudget, movesReservationsWithoutCountingThemTwice) {
  MemoryBudget budget(1000);
  Reservation first = *budget.tryReserve(of("a", 100));
  Reservation second = *budget.tryReserve(of("b", 200));
  first = std::move(second);
  EXPECT_EQ(budget.reservedBytes(), 200u);
  EXPECT_EQ(first.bytes(), 200u);
  EXPECT_EQ(second.bytes(), 0u);
  first.shrinkTo(50);
  EXPECT_EQ(budget.reservedBytes(), 50u);
  first.shrinkTo(70);
  EXPECT_EQ(first.bytes(), 50u);
}

TEST(MemoryBudget, leavesEachIdentityAQuarterOfWhatOthersLeave) {
  MemoryBudget budget(1600);
  EXPECT_EQ(budget.leftFor("a"), 1200u);
  const auto first = budget.tryReserve(of("a", 1200));
  ASSERT_TRUE(first);
  EXPECT_EQ(budget.leftFor("a"), 0u);
  EXPECT_EQ(budget.leftFor("b"), 300u);
  const auto second = budget.tryReserve(of("b", 300));
  ASSERT_TRUE(second);
  EXPECT_FALSE(budget.tryReserve(of("b", 1)));
  EXPECT_EQ(budget.leftFor("c"), 75u);
  EXPECT_EQ(budget.leftFor(""), 100u);
}

TEST(MemoryBudget, countsWhatIsThereAlready) {
  MemoryBudget budget(1000);
  const Reservation program = budget.charge(MemoryUse::kProgram, 1200);
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kProgram), 1200u);
  EXPECT_EQ(budget.leftFor("a"), 0u);
  EXPECT_EQ(budget.mostForOne(), 0u);
  EXPECT_FALSE(budget.tryReserve(of("", 1)));
}

TEST(MemoryBudget, givesUpWhatIsIdleBeforeItRefuses) {
  MemoryBudget budget(1000);
  const auto shelf = std::make_shared<Shelf>(800);
  budget.addIdle(shelf);
  EXPECT_EQ(budget.idleBytes(), 800u);
  EXPECT_TRUE(budget.tryReserve(of("", 200)));
  EXPECT_EQ(budget.idleBytes(), 800u);
  EXPECT_TRUE(budget.tryReserve(of("", 201)));
  EXPECT_EQ(budget.idleBytes(), 0u);
  EXPECT_EQ(shelf->last_unused_for.count(), 0);
}

TEST(MemoryBudget, givesUpNothingForWhatWouldNeverFit) {
  MemoryBudget budget(1000);
  const auto shelf = std::make_shared<Shelf>(100);
  budget.addIdle(shelf);
  EXPECT_FALSE(budget.tryReserve(of("a", 751)));
  EXPECT_EQ(budget.idleBytes(), 100u);
  EXPECT_TRUE(budget.tryReserve(of("a", 750)));
  EXPECT_EQ(budget.idleBytes(), 0u);
}

TEST(MemoryBudget, forgetsIdleMemoryThatIsGone) {
  MemoryBudget budget(1000);
  budget.addIdle(std::make_shared<Shelf>(800));
  EXPECT_EQ(budget.idleBytes(), 0u);
  EXPECT_EQ(budget.releaseIdle(std::chrono::seconds(1)), 0u);
}

TEST(MemoryBudget, saysWhatWasAskedWhatIsLeftAndWhatWouldFit) {
  std::vector<MemoryUse> refused;
  MemoryBudget budget(4'000'000, [&](MemoryUse use) { refused.push_back(use); });
  uint64_t told_bytes = 0;
  const auto fits = [&](uint64_t left_bytes) {
    told_bytes = left_bytes;
    return "A smaller one fits";
  };
  const auto granted = budget.reserve(of("10.0.0.7", 5'000'000), "the frame", fits);
  EXPECT_EQ(granted.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(granted.status().message(),
            "the frame takes 5 MB of memory; 3 MB of the server's 4 MB (memory.budget) are left "
            "for 10.0.0.7. A smaller one fits. For more, raise memory.budget");
  EXPECT_EQ(told_bytes, 3'000'000u);
  EXPECT_FALSE(retryDelayNs(granted.status()));
  EXPECT_EQ(refused, std::vector{MemoryUse::kFrames});
}

TEST(MemoryBudget, saysWhenItIsWorthAnotherTry) {
  MemoryBudget budget(4000);
  const auto held = budget.tryReserve(of("a", 2000));
  const auto granted = budget.reserve(of("a", 1001), "the display", [](uint64_t) { return ""; });
  EXPECT_TRUE(retryDelayNs(granted.status()));
  EXPECT_NE(granted.status().message().find("Nothing smaller fits. End something else"),
            std::string::npos);
}

TEST(MemoryBudget, mayDieBeforeItsReservations) {
  auto budget = std::make_unique<MemoryBudget>(1000);
  Reservation held = *budget->tryReserve(of("a", 100));
  budget.reset();
  held.release();
  EXPECT_EQ(held.bytes(), 0u);
}

TEST(MemoryBudget, neverGivesMoreThanItHasToManyThreads) {
  MemoryBudget budget(1000);
  std::vector<std::jthread> clients;
  for (const char* identity : {"a", "b", "c", "d"}) {
    clients.emplace_back([&budget, identity] {
      for (int round = 0; round < 2000; ++round) {
        const auto held = budget.tryReserve(of(identity, 300, MemoryUse::kDisplays));
        EXPECT_LE(budget.reservedBytes(), 1000u);
      }
    });
  }
  clients.clear();
  EXPECT_EQ(budget.reservedBytes(), 0u);
  EXPECT_EQ(budget.leftFor("a"), 750u);
}

TEST(MemoryText, hasThreeFiguresAtMost) {
  EXPECT_EQ(memoryText(0), "0 bytes");
  EXPECT_EQ(memoryText(999), "999 bytes");
  EXPECT_EQ(memoryText(66'000), "66 kB");
  EXPECT_EQ(memoryText(268'435'456), "268 MB");
  EXPECT_EQ(memoryText(1'540'000'000), "1.54 GB");
  EXPECT_EQ(memoryText(128'000'000'000), "128 GB");
}

TEST(MemoryBudget, saysTheMostThatWasReservedAtATimeSinceTheLastLook) {
  MemoryBudget budget(1000);
  const Reservation kept = *budget.tryReserve({.bytes = 100});
  budget.tryReserve({.bytes = 500})->release();
  EXPECT_EQ(budget.takePeakBytes(), 600U);
  EXPECT_EQ(budget.takePeakBytes(), 100U);
}

}  // namespace
}  // namespace viewloom::memory_budget_test
