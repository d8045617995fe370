// SPDX-License-Identifier: Apache-2.0
// Device memory of strips on their way, with the commands that trace them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "admission/memory_budget.h"
#include "base/slot_pool.h"
#include "gpu/submission.h"
#include "trace/trace_slot.h"

namespace viewloom {

struct StripTrace {
  StripTrace(const Device& device, const TraceSlotShape& shape, Reservation reserved)
      : memory(std::move(reserved)),
        slot(device, shape),
        recorders{CommandRecorder(device), CommandRecorder(device)} {}

  const Reservation memory;
  TraceSlot slot;
  // Parts of a strip take turns: one is recorded while the device does the one before it.
  std::array<CommandRecorder, 2> recorders;
  std::array<uint64_t, 2> submitted = {};  // timeline values of their last submissions
};

// Slots are kept apart by the planes that they trace, and grow to the largest strip that was asked
// for since there were none. Device and memory outlive it. Thread-safety: take() from one thread.
class StripTraces {
 public:
  // So many with the same planes. `on_return` is called on any thread.
  StripTraces(const Device& device, MemoryBudget& memory, uint32_t slot_count_max,
              const std::function<void()>& on_return);

  // Those for eyes are no others: tracked displays wait for nobody else's strips. Holding it keeps
  // it from reuse. nullptr: all are lent, or the budget has no room until one comes back. Throws
  // EngineOutOfMemory where none would come back.
  std::shared_ptr<StripTrace> take(const TraceSlotShape& shape, bool is_for_eyes);

 private:
  struct Ring {
    bool is_for_eyes = false;
    TraceSlotShape largest;
    SlotPool<StripTrace> slots;
  };

  std::unique_ptr<StripTrace> make(const TraceSlotShape& shape);
  bool areSomeLent() const;

  const Device& device_;
  MemoryBudget& memory_;
  std::vector<Ring> rings_;
};

}  // namespace viewloom
