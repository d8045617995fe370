// SPDX-License-Identifier: Apache-2.0
#include "base/slot_pool.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace viewloom::slot_pool_test {
namespace {

struct Slot {
  int size = 0;
};

class SlotPoolTest : public testing::Test {
 protected:
  std::shared_ptr<Slot> take(int size) {
    return pool_.take([=](const Slot& slot) { return slot.size >= size; },
                      [=, this] {
                        ++made_count_;
                        return std::make_unique<Slot>(Slot{size});
                      });
  }

  int made_count_ = 0;
  int returned_count_ = 0;
  SlotPool<Slot> pool_{2, [this] { ++returned_count_; }};
};

TEST_F(SlotPoolTest, lendsEachSlotOnceAndNoMoreThanItMayHold) {
  const auto first = take(1);
  const auto second = take(1);
  ASSERT_TRUE(first && second);
  EXPECT_NE(first, second);
  EXPECT_EQ(take(1), nullptr);
}

TEST_F(SlotPoolTest, reusesAReturnedSlotThatFits) {
  for (int use = 0; use < 5; ++use) EXPECT_TRUE(take(3));
  EXPECT_EQ(made_count_, 1);
  EXPECT_EQ(returned_count_, 5);
}

TEST_F(SlotPoolTest, putsALargerSlotInThePlaceOfAFreeMisfit) {
  const auto held = take(1);
  take(1).reset();
  const auto larger = take(2);
  ASSERT_TRUE(larger);
  EXPECT_EQ(larger->size, 2);
  EXPECT_EQ(take(1), nullptr) << "the misfit is gone, two slots exist";
}

TEST_F(SlotPoolTest, keepsItsRoomWhenMakingASlotFails) {
  const auto fails = []() -> std::unique_ptr<Slot> { throw std::runtime_error("no memory"); };
  const auto any = [](const Slot&) { return true; };
  for (int attempt = 0; attempt < 3; ++attempt)
    EXPECT_THROW(pool_.take(any, fails), std::runtime_error);
  const auto first = take(1);
  const auto second = take(1);
  EXPECT_TRUE(first && second);
}

TEST_F(SlotPoolTest, holdsMoreOrFewerWhenItIsToldTo) {
  pool_.setCountMax(3);
  auto first = take(1), second = take(1);
  const auto third = take(1);
  EXPECT_TRUE(third);
  pool_.setCountMax(1);
  first.reset();
  second.reset();
  EXPECT_EQ(returned_count_, 2);
  EXPECT_EQ(take(1), nullptr) << "the third is the one that may be";
  pool_.setCountMax(2);
  EXPECT_TRUE(take(1));
  EXPECT_EQ(made_count_, 4) << "those too many were not kept";
}

TEST_F(SlotPoolTest, letsBorrowedSlotsOutliveIt) {
  int returned_count = 0;
  std::shared_ptr<Slot> slot;
  {
    SlotPool<Slot> pool(1, [&] { ++returned_count; });
    slot = pool.take([](const Slot&) { return true; }, [] { return std::make_unique<Slot>(); });
  }
  slot.reset();
  EXPECT_EQ(returned_count, 1);
}

TEST_F(SlotPoolTest, givesUpFreeSlotsThatWereNotUsedForSoLong) {
  auto lent = take(1);
  take(2);
  EXPECT_EQ(pool_.lentCount(), 1u);
  pool_.idleMemory()->releaseIdle(std::chrono::hours(1));
  take(2);
  EXPECT_EQ(made_count_, 2);
  pool_.idleMemory()->releaseIdle(std::chrono::nanoseconds(0));
  take(2);
  EXPECT_EQ(made_count_, 3);
  EXPECT_FALSE(pool_.isEmpty());
  lent.reset();
  pool_.idleMemory()->releaseIdle(std::chrono::nanoseconds(0));
  EXPECT_TRUE(pool_.isEmpty());
}

}  // namespace
}  // namespace viewloom::slot_pool_test
