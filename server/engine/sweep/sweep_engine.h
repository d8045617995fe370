// SPDX-License-Identifier: Apache-2.0
// Sweeps atlases on the worker threads (shaders/sweep.md): views beside the only source of a
// frame, in its rows.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "admission/memory_budget.h"
#include "base/cost_estimate.h"
#include "base/keyed_slots.h"
#include "base/worker_pool.h"
#include "engine/engine.h"
#include "sweep/view_sweeper.h"

namespace viewloom {

// Sweepers that threads take for a piece. Thread-safety: all methods may be called from any thread.
class SweeperShelf {
 public:
  std::unique_ptr<ViewSweeper> take();
  void putBack(std::unique_ptr<ViewSweeper> sweeper);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<ViewSweeper>> free_;
};

// An atlas, and its memory in the budget.
struct HeldAtlas {
  Reservation memory;
  SweptAtlas planes;  // last: it goes first
};

// Lends atlases. One for which the budget had no room waits aside: its return would tell everybody
// that there is room. Thread-safety: as KeyedSlots, but one thread takes and puts aside.
class AtlasPool {
 public:
  AtlasPool(size_t atlas_count_max, std::function<void()> on_return)
      : slots_(atlas_count_max, std::move(on_return)) {}

  // nullptr: the borrower of this key holds one, and all others are lent.
  std::shared_ptr<HeldAtlas> take(const std::string& key);
  void putAside(std::shared_ptr<HeldAtlas> atlas) { aside_ = std::move(atlas); }
  bool hasRoom(const std::string& key) { return aside_ || slots_.hasRoom(key); }
  size_t lentCount() const { return slots_.lentCount() - (aside_ ? 1 : 0); }
  std::shared_ptr<IdleMemory> idleMemory() const { return slots_.idleMemory(); }

 private:
  KeyedSlots<HeldAtlas> slots_;
  std::shared_ptr<HeldAtlas> aside_;
};

class SweepEngine final : public Engine {
 public:
  // `atlas_count`: atlases that are made at a time, beside one small one of each picture and one
  // large one of each payer. `workers` prepare frames. Both they and the memory outlive the engine.
  SweepEngine(uint32_t atlas_count, WorkerPool& workers, MemoryBudget& memory = unboundedMemory());

  TraceMethod method() const override { return TraceMethod::kSweep; }
  void connect(EngineEvents events) override { events_ = std::move(events); }
  bool takes(const Frame& frame) const override;
  uint64_t preparedBytes(const FrameFormat& format) const override;
  std::unique_ptr<FramePreparer> preparer() override;
  PlanPtr plan(const PicturePtr& picture, const PreparedFrame& frame) const override;
  bool isReady(const AtlasOrder&, std::function<void()>) override { return true; }
  bool hasRoomForEyes(const std::string& payer) override {
    return atlases_for_eyes_.hasRoom(payer);
  }
  std::unique_ptr<Making> begin(AtlasOrder order, HandOn hand_on) override;
  bool workAhead() override { return false; }
  void drain() override {}

 private:
  // Memory for the atlas; false = the budget has none.
  bool makeRoom(const AtlasOrder& order, const TraceOutputs& planes, HeldAtlas& atlas);

  EngineEvents events_;
  WorkerPool& workers_;
  MemoryBudget& memory_;
  const std::shared_ptr<SweeperShelf> sweepers_;
  AtlasPool atlases_;                            // by picture or payer
  AtlasPool atlases_for_eyes_;                   // by payer
  const std::shared_ptr<CostEstimate> px_cost_;  // of all pictures
};

}  // namespace viewloom
