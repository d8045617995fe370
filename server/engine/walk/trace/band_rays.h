// SPDX-License-Identifier: Apache-2.0
// The rays that bands are made of: one of each px, again and again.
#pragma once

#include <cstdint>
#include <vector>

#include "picture/trace_job.h"
#include "structure/structure_slot.h"
#include "trace/band_parts.h"

namespace viewloom {

// Rows [first, end) of a band.
struct RowSpan {
  uint32_t first = 0;
  uint32_t end = 0;
};

// Px [first, end) of each of those rows.
struct ColumnSpan {
  uint32_t first = 0;
  uint32_t end = 0;
};

// One ray of each px.
struct BandRays {
  uint32_t sample = 0;
  bool through_lens = false;
  uint32_t wanted = 0;        // abi::kWant... flags
  bool is_of_blocks = false;  // of px in blocks that are not complete alone
  bool lists_hidden = false;  // px whose ray ends behind something
  // Not 0: the mean of so many rays through the lens, of px that are listed alone; alpha 0.
  uint32_t count_of_hidden = 0;

  // Whether they are those of px or blocks on the slot's list of what is incomplete.
  bool areListed() const { return is_of_blocks || count_of_hidden > 0; }
};

// Whether the device gathers the lens of such a picture of this structure: rays that see through
// something have no single surface to compare with.
bool gathersOnDevice(const TraceJob& job, const StructureSlot& structure);

// Rays of those samples of a part that are walked, in their order.
std::vector<BandRays> raysOfPart(const TraceJob& job, const StructureSlot& first_structure,
                                 const TraceOutputs& outputs, const BandPart& part);

// Rays in one of the structures of a job.
struct Walk {
  const StructureSlot& structure;
  const TraceJob& job;
  uint32_t index = 0;  // of the walk
  BandRays rays = {};
};

// Push constants of kernels that walk these rows; `color`: the structure's, as it is read.
abi::TracePush tracePush(const Walk& walk, const LayeredBuffer& color, BandRows rows);

}  // namespace viewloom
