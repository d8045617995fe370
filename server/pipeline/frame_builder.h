// SPDX-License-Identifier: Apache-2.0
// Gives a frame the forms that displays take it in.
#pragma once

#include <atomic>
#include <memory>

#include "base/worker_pool.h"
#include "pipeline/gpu_loop.h"
#include "pipeline/pipeline_links.h"
#include "pipeline/resident_structure.h"
#include "pipeline/slot_pool.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread.
class FrameBuilder {
 public:
  FrameBuilder(const PipelineLinks& links, GpuLoop& gpu) : links_(links), gpu_(gpu) {}

  // A slot of these for such frames; nullptr while all are lent. It is built for the walk where
  // that is all there is, or where `is_walked` says so, which is reset then; in this memory, which
  // all slots share. Throws when the device cannot hold it (isOutOfDeviceMemory).
  std::shared_ptr<StructureBuild> takeSlot(SlotPool<StructureBuild>& slots,
                                           FrameBuildMemory& memory, const Frame& frame,
                                           std::atomic<bool>& is_walked) const;

  // Builds the frame in the slot, and says in `structure` what was made of it and when.
  void build(const FramePtr& frame, std::shared_ptr<StructureBuild> slot,
             ResidentStructure& structure);

  WorkerPool& workers() { return workers_; }

 private:
  const PipelineLinks& links_;
  GpuLoop& gpu_;
  WorkerPool workers_;
};

}  // namespace viewloom
