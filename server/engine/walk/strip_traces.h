// SPDX-License-Identifier: Apache-2.0
// Device memory of strips on their way, with the commands that trace them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "admission/memory_budget.h"
#include "base/keyed_slots.h"
#include "engine/engine.h"
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

// Slots are kept apart by the planes that they trace and by their size, so that small strips do not
// take the memory of large ones. They grow to the largest strip of their size that was asked for
// since there were none. Device and memory outlive it. Thread-safety: take() from one thread.
class StripTraces {
 public:
  // So many of the same planes and size, beside one small one of each picture and one large one of
  // each payer. `on_return` is called on any thread.
  StripTraces(const Device& device, MemoryBudget& memory, uint32_t slot_count,
              std::function<void()> on_return)
      : device_(device),
        memory_(memory),
        slot_count_(slot_count),
        on_return_(std::move(on_return)) {}

  // For an order's strips. Holding it keeps it from reuse. nullptr: its picture or its payer has
  // one, and all others are lent, or the budget has no room until one comes back. Throws
  // EngineOutOfMemory where none would come back.
  std::shared_ptr<StripTrace> take(const TraceSlotShape& shape, const AtlasOrder& order);

 private:
  struct Ring {
    TraceSlotShape largest;
    KeyedSlots<StripTrace> slots;
  };
  // Planes, and the power of two that the px of a strip are less than.
  using Kind = std::tuple<ColorForm, bool, bool, int>;
  static Kind kindOf(const TraceSlotShape& shape);

  Ring& ringOf(const TraceSlotShape& shape);
  std::unique_ptr<StripTrace> make(const TraceSlotShape& shape);
  bool areSomeLent() const;

  const Device& device_;
  MemoryBudget& memory_;
  const uint32_t slot_count_;
  const std::function<void()> on_return_;
  std::map<Kind, Ring> rings_;
};

}  // namespace viewloom
