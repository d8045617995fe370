// SPDX-License-Identifier: Apache-2.0
// Slots come back, and are given up, on threads and in destructors that no exception may leave.
#include "base/slot_pool.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <new>
#include <vector>

#include "support/failing_allocations.h"

namespace viewloom::slots_out_of_memory_test {
namespace {

// From so many slots on, a list of them is an allocation that may fail.
constexpr size_t kSlots = test::kMayFail_bytes / (2 * sizeof(void*));

struct Slot {};

std::vector<std::shared_ptr<Slot>> takeAll(SlotPool<Slot>& pool) {
  std::vector<std::shared_ptr<Slot>> taken;
  while (std::shared_ptr<Slot> slot =
             pool.take([](const Slot&) { return true; }, [] { return std::make_unique<Slot>(); })) {
    taken.push_back(std::move(slot));
  }
  return taken;
}

TEST(SlotsOutOfMemory, comeBackAllTheSame) {
  SlotPool<Slot> pool(1, [] {});
  pool.setCountMax(2 * kSlots);
  std::vector<std::shared_ptr<Slot>> taken = takeAll(pool);
  test::failAllocation(0);
  for (std::shared_ptr<Slot>& slot : taken) slot.reset();
  EXPECT_FALSE(test::stopFailing()) << "a slot that came back took memory";
  EXPECT_EQ(pool.lentCount(), 0u);
}

TEST(SlotsOutOfMemory, areGivenUpAllTheSame) {
  SlotPool<Slot> pool(2 * kSlots, [] {});
  takeAll(pool).clear();
  test::failAllocation(0);
  pool.idleMemory()->releaseIdle(std::chrono::nanoseconds(0));
  EXPECT_FALSE(test::stopFailing()) << "slots that were given up took memory";
  EXPECT_TRUE(pool.isEmpty());
}

TEST(SlotsOutOfMemory, stayAsManyWhereMoreHaveNoRoom) {
  SlotPool<Slot> pool(1, [] {});
  test::failAllocation(0);
  EXPECT_THROW(pool.setCountMax(2 * kSlots), std::bad_alloc);
  test::stopFailing();
  EXPECT_EQ(takeAll(pool).size(), 1u);
}

}  // namespace
}  // namespace viewloom::slots_out_of_memory_test
