// SPDX-License-Identifier: Apache-2.0
// Memory of the server for one stream and one display, measured on its own slots.
#pragma once

#include <cstdint>
#include <optional>

#include "base/worker_pool.h"
#include "gpu/device.h"
#include "sweep/view_sweeper.h"

namespace viewloom::bench {

// Allocations of the server for a frame and an atlas of it: on the device, and on the host.
struct MemoryUse {
  uint64_t structure_bytes = 0;
  // Trace target with the default encoding of displays. The walk: a strip, as high as bands are.
  // The sweep: the whole atlas in the form that the encoder takes, and the memory of its threads.
  uint64_t trace_target_bytes = 0;
  uint64_t frame_input_bytes = 0;  // decoded planes
  // The most there was while a frame was taken in, built and traced. None under a sanitizer.
  std::optional<uint64_t> peak_bytes;
  // Memory of one more frame on its way, from its build to its last band: another structure and
  // trace target, without the temporary memory of builds. For the sweep also its planes, which it
  // reads to the end.
  uint64_t further_frame_bytes = 0;

  uint64_t totalBytes() const { return structure_bytes + trace_target_bytes + frame_input_bytes; }
};

// Builds the frame and traces some of it, twice: only then do drivers hold what they compiled.
MemoryUse walkMemory(const Device& device, const Frame& frame, const TraceJob& job);

// Whether allocations of the sweep are seen on the heap: not under a sanitizer.
bool canMeasureSweeps();

// Prepares and sweeps a frame that can be swept.
MemoryUse sweepMemory(const Frame& frame, const TraceJob& job, const SweepPlan& plan,
                      WorkerPool& workers);

}  // namespace viewloom::bench
