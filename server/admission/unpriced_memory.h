// SPDX-License-Identifier: Apache-2.0
// Memory that nothing has reserved: kernels beyond those that were reserved for, and parts of the
// heap that cannot be given back.
#pragma once

#include <cstdint>

#include "admission/memory_budget.h"

namespace viewloom {

// Keeps the budget's ledger from saying less than what lies in memory. Thread-safety: none.
class UnpricedMemory {
 public:
  // `budget` outlives it.
  explicit UnpricedMemory(MemoryBudget& budget) : budget_(budget) {}

  // To be called now and then, with the bytes of this process that lie in memory.
  void note(uint64_t resident_bytes);

  // Charged to the budget for it.
  uint64_t bytes() const { return charged_.bytes(); }

 private:
  MemoryBudget& budget_;
  Reservation charged_;
};

}  // namespace viewloom
