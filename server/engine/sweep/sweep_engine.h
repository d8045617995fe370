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
#include "base/worker_pool.h"
#include "engine/engine.h"
#include "sweep/atlas_pool.h"
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
  std::optional<std::chrono::nanoseconds> workAhead() override { return std::nullopt; }
  void drain() override {}

 private:
  EngineEvents events_;
  WorkerPool& workers_;
  MemoryBudget& memory_;
  const std::shared_ptr<SweeperShelf> sweepers_;
  AtlasPool atlases_;                            // by picture or payer
  AtlasPool atlases_for_eyes_;                   // by payer
  const std::shared_ptr<CostEstimate> px_cost_;  // of all pictures
};

}  // namespace viewloom
