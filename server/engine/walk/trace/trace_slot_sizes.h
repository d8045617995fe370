// SPDX-License-Identifier: Apache-2.0
// How many bytes each buffer of a trace slot has.
#pragma once

#include <cstdint>

#include "frame/size.h"
#include "shared/trace_abi.h"
#include "trace/trace_slot_shape.h"

namespace viewloom {

// Counters of rays by class, in sets (shaders/shared/trace_abi.h).
inline constexpr uint64_t kCounterCount = uint64_t{abi::kCounterSets} * abi::kCounterStride;

// Memory limit for the answers of several walks, which are merged before the next rows are traced.
// A single row may take more.
inline constexpr uint64_t kAnswersBytesMax = uint64_t{32} << 20;

// How the answers of several walks to a piece of a band lie in memory, walk after walk.
struct AnswersLayout {
  uint32_t row_count = 0;
  uint32_t stride = 0;  // answers from one walk to the next
};
AnswersLayout answersLayout(uint32_t width_px, uint32_t row_count, uint32_t walk_count);
// The same of reflected rays, where what is known of them takes its part of the memory.
AnswersLayout reflectedAnswersLayout(uint32_t width_px, uint32_t row_count, uint32_t walk_count);

// Answers [first, end) of each walk to px of a piece, row by row; they begin with a group of
// invocations.
struct AnswerSpan {
  uint32_t first = 0;
  uint32_t end = 0;
};

// Bytes of each buffer of TraceSlot; 0 = there is none.
struct TraceSlotSizes {
  // Planes that the CPU reads; where it does not share the device's memory, there are two of each.
  uint64_t color = 0;
  uint64_t depth = 0;
  uint64_t mask = 0;
  uint64_t linear = 0;
  uint64_t records = 0;
  uint64_t counters = 0;
  // Buffers of the device alone.
  uint64_t unpacked = 0;
  uint64_t answers = 0;
  uint64_t sample = 0;
  uint64_t sums = 0;
  uint64_t met = 0;
  uint64_t met_lists = 0;
  uint64_t incomplete = 0;
  uint64_t unfinished = 0;
  uint64_t hits = 0;
  uint64_t paths = 0;
  uint64_t reflected = 0;
  uint64_t reflection_settings = 0;

  uint64_t readableBytes() const { return color + depth + mask + linear + records + counters; }
  uint64_t deviceBytes() const {
    return unpacked + answers + sample + sums + met + met_lists + incomplete + unfinished + hits +
           paths + reflected + reflection_settings;
  }
};

// `is_software`: the device is the CPU.
TraceSlotSizes traceSlotSizes(const TraceSlotShape& shape, bool is_software);

// Bytes of colour of an image of this size.
uint64_t colorBytesOf(SizePx size_px, ColorForm form);

}  // namespace viewloom
