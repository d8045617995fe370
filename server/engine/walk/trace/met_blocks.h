// SPDX-License-Identifier: Apache-2.0
// Blocks of px that share what the walked rays of a lens met.
#pragma once

#include <cstdint>

#include "picture/trace_job.h"

namespace viewloom {

// Blocks of px (shaders/lib/rays/met_blocks.glsl) of a band.
struct MetBlocks {
  uint32_t first_row = 0;  // of all rows of blocks
  uint32_t row_count = 0;
  uint32_t per_row = 0;
};
MetBlocks metBlocks(const AtlasLayout& layout, BandRows rows);
// Bytes of the lists of a band with so many rows, wherever it begins.
uint64_t metListsBytes(const AtlasLayout& layout, uint32_t row_count_max);
// Upper bound of the list of incomplete places: blocks where the device gathers a lens, pixels
// where the host does.
uint64_t incompleteCount(const TraceJob& job, uint32_t row_count_max);

// The walked rays of each px come in rounds [first, end), after each of which blocks are looked at:
// those that are complete have no more. Each round is as many as all before it: what they have not
// met is missed the less, the more there are.
struct MetRound {
  uint32_t first = 0;
  uint32_t end = 0;
};
// The round that a sample belongs to, of so many samples.
MetRound metRound(uint32_t sample, uint32_t sample_count);

}  // namespace viewloom
