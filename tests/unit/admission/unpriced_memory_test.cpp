// SPDX-License-Identifier: Apache-2.0
#include "admission/unpriced_memory.h"

#include <gtest/gtest.h>

namespace viewloom::unpriced_memory_test {
namespace {

TEST(UnpricedMemory, chargesWhatNobodyReserved) {
  MemoryBudget budget(1000);
  const Reservation program = budget.charge(MemoryUse::kProgram, 300);
  UnpricedMemory unpriced(budget);
  unpriced.note(250);
  EXPECT_EQ(budget.reservedBytes(), 300u);
  unpriced.note(500);
  EXPECT_EQ(budget.reservedBytes(), 500u);
  unpriced.note(600);
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kProgram), 600u);
}

TEST(UnpricedMemory, leavesReservedMemoryToThoseWhoReservedIt) {
  MemoryBudget budget(1000);
  UnpricedMemory unpriced(budget);
  unpriced.note(200);
  const auto frame = budget.tryReserve({.use = MemoryUse::kFrames, .bytes = 300});
  ASSERT_TRUE(frame.has_value());
  unpriced.note(500);
  EXPECT_EQ(budget.reservedBytes(), 500u);
  unpriced.note(400);
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kProgram), 100u);
}

TEST(UnpricedMemory, givesBackWhatIsGone) {
  MemoryBudget budget(1000);
  UnpricedMemory unpriced(budget);
  unpriced.note(5000);
  EXPECT_EQ(budget.leftFor(""), 0u);
  unpriced.note(10);
  EXPECT_EQ(budget.reservedBytes(), 10u);
  unpriced.note(0);
  EXPECT_EQ(budget.reservedBytes(), 0u);
}

}  // namespace
}  // namespace viewloom::unpriced_memory_test
