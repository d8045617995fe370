// SPDX-License-Identifier: Apache-2.0
// Gives a frame the forms that engines take it in.
#pragma once

#include <functional>
#include <memory>

#include "base/slot_pool.h"
#include "pipeline/pipeline_links.h"
#include "schedule/resident_structure.h"

namespace viewloom {

// Description of a structure from the frame alone.
ResidentStructure describe(const Frame& frame);

// Thread-safety: all methods may be called from any thread.
class FrameBuilder {
 public:
  explicit FrameBuilder(const PipelineLinks& links) : links_(links) {}

  // Whether the first engine that takes the frame can prepare it (Engine::isReadyFor).
  bool isReadyFor(const Frame& frame, std::function<void()> then) const;

  // A slot of these for the frame; nullptr while all are lent. Throws EngineOutOfMemory.
  std::shared_ptr<FrameForms> takeSlot(SlotPool<FrameForms>& slots, StreamPreparers& preparers,
                                       const FramePtr& frame) const;

  // Prepares the frame that the slot was taken for, and says in `structure` what was made of it and
  // when.
  void build(const Frame& frame, std::shared_ptr<FrameForms> slot, const PreparationEvents& events,
             ResidentStructure& structure) const;

  WorkerPool& workers() const { return *links_.engines.workers; }

 private:
  const PipelineLinks& links_;
};

}  // namespace viewloom
