// SPDX-License-Identifier: Apache-2.0
// Gives memory that nobody uses any more back to the system.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <thread>

#include "admission/memory_budget.h"

namespace viewloom {

// Decides when freed memory is worth a walk through the heap, during which others wait for memory:
// when what is in use has stayed below its highest by kWorthReturning_bytes for kLooks, when as
// much was given up, or when as much more lies in memory for kLooks than is in use: a compiler of
// kernels has come and gone. At most once in kLooks. A stream whose frames come and go does not
// count. Thread-safety: none.
class HeapWatch {
 public:
  static constexpr uint64_t kWorthReturning_bytes = uint64_t{16} << 20;
  static constexpr size_t kLooks = 3;

  struct Look {
    uint64_t used_bytes = 0;      // that are reserved: the most at a time since the last call
    uint64_t released_bytes = 0;  // given up since then
    uint64_t resident_bytes = 0;  // of the process, in memory now
  };
  // To be called at regular intervals. True: return freed memory now.
  bool note(const Look& look);

 private:
  bool isLessUsed(uint64_t lately_bytes);

  // The newest calls: in use, and in memory beyond that. The latter is often negative, as much is
  // reserved before it is needed.
  std::array<uint64_t, kLooks> last_bytes_{};
  std::array<int64_t, kLooks> last_beyond_bytes_{};
  size_t call_count_ = 0;
  // Since memory was returned last.
  uint64_t highest_bytes_ = 0;
  uint64_t released_bytes_ = 0;
  std::optional<int64_t> left_bytes_;  // beyond what is in use, when that was known again
  size_t pause_count_ = kLooks;
};

// A thread that wakes once a second. It gives up what has waited for reuse for three seconds, and
// returns what is free. Thread-safety: the constructor and the destructor only.
class MemoryReturn {
 public:
  // `on_tick` is called each second, on the thread, before anything is given up. It answers how
  // much of what is reserved nobody uses (UnpricedMemory). Both outlive it.
  MemoryReturn(MemoryBudget& budget, std::function<uint64_t()> on_tick);

 private:
  std::jthread thread_;
};

}  // namespace viewloom
