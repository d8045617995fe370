// SPDX-License-Identifier: Apache-2.0
// Atlases in memory that are lent for one sweep after another.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "admission/memory_budget.h"
#include "base/keyed_slots.h"
#include "sweep/view_sweeper.h"

namespace viewloom {

// An atlas, and its memory in the budget.
struct HeldAtlas {
  // Whether it has what such a picture needs, and not much more.
  bool fits(const TraceJob& picture, const TraceOutputs& outputs) const;
  // Takes from the budget what such a picture needs. False: it has no room, and the atlas is empty.
  bool makeRoom(MemoryBudget& budget, const TraceJob& picture, const TraceOutputs& outputs);

  Reservation memory;
  SweptAtlas planes;  // last: it goes first
};

// Lends atlases. One for which the budget had no room waits aside: its return would tell everybody
// that there is room. Thread-safety: as KeyedSlots, but one thread takes and puts aside.
class AtlasPool {
 public:
  AtlasPool(size_t atlas_count_max, std::function<void()> on_return)
      : slots_(atlas_count_max, std::move(on_return)) {}

  // One that fits, or a new one. nullptr: the borrower of this key holds one, and all others are
  // lent.
  std::shared_ptr<HeldAtlas> take(const std::string& key, const TraceJob& picture,
                                  const TraceOutputs& outputs);
  void putAside(std::shared_ptr<HeldAtlas> atlas) { aside_ = std::move(atlas); }
  bool hasRoom(const std::string& key) { return aside_ || slots_.hasRoom(key); }
  size_t lentCount() const { return slots_.lentCount() - (aside_ ? 1 : 0); }
  std::shared_ptr<IdleMemory> idleMemory() const { return slots_.idleMemory(); }

 private:
  KeyedSlots<HeldAtlas> slots_;
  std::shared_ptr<HeldAtlas> aside_;
};

}  // namespace viewloom
