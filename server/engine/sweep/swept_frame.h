// SPDX-License-Identifier: Apache-2.0
// A frame as sweeps take it.
#pragma once

#include <string>
#include <utility>

#include "admission/memory_budget.h"
#include "base/worker_pool.h"
#include "engine/engine.h"
#include "sweep/sweep_source.h"

namespace viewloom {

// Thread-safety: as of PreparedFrame.
class SweptFrame final : public PreparedFrame {
 public:
  SweptFrame(WorkerPool& workers, MemoryBudget& memory) : workers_(workers), memory_(memory) {}

  void take(FramePtr frame) override { frame_ = std::move(frame); }
  void reserve() override {
    const uint64_t wanted_bytes = SweepSource::bytesFor(frame_->format);
    if (reserved_.bytes() == wanted_bytes) return;
    source_ = SweepSource();
    reserved_.release();
    absl::StatusOr<Reservation> reserved = memory_.reserve(
        {.use = MemoryUse::kStructures, .identity = frame_->publisher, .bytes = wanted_bytes},
        "preparing the frame", [](uint64_t) { return "Publish smaller frames or fewer layers"; });
    if (!reserved.ok()) throw EngineOutOfMemory(std::string(reserved.status().message()));
    reserved_ = *std::move(reserved);
  }
  // All workers take its pieces, between which they serve others.
  int64_t prepare(const Clock&, const PreparationEvents&) override {
    if (!frame_) return 0;
    reserve();
    source_.prepare(std::move(frame_), workers_);
    return 0;
  }
  FrameMeasures measures() const override {
    return {.stats = source_.measured().stats, .depths = source_.measured().depths};
  }
  const SweepSource& source() const { return source_; }

 private:
  WorkerPool& workers_;
  MemoryBudget& memory_;
  Reservation reserved_;
  FramePtr frame_;      // that is not prepared yet
  SweepSource source_;  // keeps the last frame that was prepared until the next one is
};

// Source of a frame that the sweep has prepared.
inline const SweepSource& sourceOf(const PreparedFrame& frame) {
  return static_cast<const SweptFrame&>(frame).source();
}

}  // namespace viewloom
