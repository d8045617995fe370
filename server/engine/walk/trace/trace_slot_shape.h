// SPDX-License-Identifier: Apache-2.0
// How much a slot for bands has to hold.
#pragma once

#include <cstdint>

#include "picture/trace_job.h"

namespace viewloom {

struct TraceSlotShape {
  uint32_t width_px = 0;
  uint32_t row_count_max = 0;
  uint32_t tile_count_max = 0;
  uint32_t walk_count = 1;
  uint32_t sample_count = 1;
  uint32_t lens_point_count = 0;  // of all px of the pattern
  bool sums_light = false;
  uint32_t met_count = 0;         // rays a px of which it is kept what they met
  uint64_t met_lists_bytes = 0;   // 0 = no second stage of a lens on the device
  uint64_t incomplete_count = 0;  // blocks or px that may be walked further
  TraceOutputs outputs;
  bool reflects = false;  // TraceJob::reflects

  // Whether a slot of this shape can hold a band of that one.
  bool holds(const TraceSlotShape& other) const;
  // Makes it hold those of that one, too, which has the same outputs.
  void include(const TraceSlotShape& other);
};

// Shape for bands of a job with so many rows at most.
TraceSlotShape slotShape(const TraceJob& job, uint32_t row_count_max, const TraceOutputs& outputs);

}  // namespace viewloom
