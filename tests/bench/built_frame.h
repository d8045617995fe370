// SPDX-License-Identifier: Apache-2.0
// A frame on a device, as the server has it once it is built: to be walked, and to be swept.
#pragma once

#include <vector>

#include "gpu/submission.h"
#include "structure/structure_slot.h"
#include "sweep/sweep_source.h"
#include "sweep/view_sweeper.h"
#include "trace/view_tracer.h"

namespace viewloom::bench {

// Structure of one source. Thread-safety: none.
class BuiltFrame {
 public:
  BuiltFrame(const Device& device, const FramePtr& frame);

  const Device& device() const { return device_; }
  double inv_z_max() const { return structure_.stats().inv_z_max; }

  // All views of a display, in its usual place; throws where the display cannot show the frame.
  TraceJob jobOf(const DisplaySpec& spec) const;

  void sweep(const TraceJob& job, const SweepPlan& plan, const TraceOutputs& outputs,
             SweptAtlas& atlas);
  // Band by band, each done before the next; the slot holds band_rows rows.
  void walk(const TraceJob& job, uint32_t band_rows, TraceSlot& slot);

 private:
  const Device& device_;
  Timeline timeline_;
  CommandRecorder recorder_;
  StructureSlot structure_;
  ViewTracer tracer_;
  WorkerPool workers_;
  SweepSource sweep_source_;
  std::vector<ViewSweeper> sweepers_;
};

}  // namespace viewloom::bench
