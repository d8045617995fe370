// SPDX-License-Identifier: Apache-2.0
// Gives memory that nobody uses any more back to the system.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <thread>

#include "admission/memory_budget.h"

namespace viewloom {

// Decides when freed memory is worth a walk through the heap, during which others wait for memory:
// when what is in use has stayed below its highest by kWorthReturning_bytes for kLooks, or when as
// much was given up, and at most once in kLooks. A stream whose frames come and go does not count.
// Thread-safety: none.
class HeapWatch {
 public:
  static constexpr uint64_t kWorthReturning_bytes = uint64_t{16} << 20;
  static constexpr size_t kLooks = 3;

  // The most that was in use at a time since the last call, and what was given up since then.
  struct Look {
    uint64_t used_bytes = 0;
    uint64_t released_bytes = 0;
  };
  // To be called at regular intervals. True: return freed memory now.
  bool note(const Look& look);

 private:
  std::array<uint64_t, kLooks> last_bytes_{};  // the newest calls
  size_t call_count_ = 0;
  // Since memory was returned last.
  uint64_t highest_bytes_ = 0;
  uint64_t released_bytes_ = 0;
  size_t pause_count_ = kLooks;
};

// A thread that wakes once a second. It gives up what has waited for reuse for three seconds, and
// returns what is free. Thread-safety: the constructor and the destructor only.
class MemoryReturn {
 public:
  // `on_tick` is called each second, on the thread, before anything is given up. Both outlive it.
  MemoryReturn(MemoryBudget& budget, std::function<void()> on_tick);

 private:
  std::jthread thread_;
};

}  // namespace viewloom
