// SPDX-License-Identifier: Apache-2.0
// Sweeps atlases on the worker threads (shaders/sweep.md): views beside the only source of a
// frame, in its rows.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "base/slot_pool.h"
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

class SweepEngine final : public Engine {
 public:
  // `atlas_count_max`: atlases of untracked displays that are made at a time. `workers` prepare
  // frames, and outlive the engine.
  SweepEngine(uint32_t atlas_count_max, WorkerPool& workers);

  TraceMethod method() const override { return TraceMethod::kSweep; }
  void connect(EngineEvents events) override { events_ = std::move(events); }
  bool takes(const Frame& frame) const override;
  std::unique_ptr<FramePreparer> preparer() override;
  PlanPtr plan(const PicturePtr& picture, const PreparedFrame& frame) const override;
  bool isReady(const AtlasOrder&, std::function<void()>) override { return true; }
  bool hasRoomForEyes() const override { return atlases_for_eyes_.hasRoom(); }
  std::unique_ptr<Making> begin(AtlasOrder order, HandOn hand_on) override;
  bool workAhead() override { return false; }
  void drain() override {}

 private:
  EngineEvents events_;
  WorkerPool& workers_;
  const std::shared_ptr<SweeperShelf> sweepers_;
  SlotPool<SweptAtlas> atlases_;
  SlotPool<SweptAtlas> atlases_for_eyes_;
};

}  // namespace viewloom
