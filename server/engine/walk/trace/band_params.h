// SPDX-License-Identifier: Apache-2.0
// Parameters of the passes over a band, in the form in which kernels take them.
#pragma once

#include "gpu/commands.h"
#include "gpu/compute_pass.h"
#include "gpu/descriptor.h"
#include "picture/trace_job.h"
#include "shared/trace_abi.h"
#include "trace/band_parts.h"

namespace viewloom {

inline uint32_t wantedFlags(const TraceOutputs& outputs) {
  return (outputs.depth ? abi::kWantDepth : 0) | (outputs.mask ? abi::kWantMask : 0) |
         (outputs.linear ? abi::kWantLinear : 0) | (outputs.records ? abi::kWantRecords : 0);
}

// Sides of up to 16384 px, and counts of tiles, in 16 bits each.
inline uint32_t packSize(SizePx size) {
  return size.width | size.height << 16;
}

// 0xRRGGBB as the band has it.
inline uint32_t redFirst(uint32_t rgb) {
  return (rgb >> 16 & 0xff) | (rgb & 0xff00) | (rgb & 0xff) << 16;
}

inline uint32_t groupCount(uint32_t invocation_count) {
  return (invocation_count + abi::kTraceGroupSize - 1) / abi::kTraceGroupSize;
}

// Groups whose invocations are these columns of px; they begin with a group.
inline GroupColumns groupsOf(const BandPart& part) {
  return {part.first_column / abi::kTraceGroupSize, groupCount(part.end_column)};
}

// Empties the list of abi::IncompleteHead, whatever used it before.
inline void recordEmptyList(Commands commands, const Buffer& list) {
  recordComputeToTransfer(commands);
  const abi::IncompleteHead empty{.group_count = {0, 1, 1}, .count = 0};
  commands.write(list, std::as_bytes(std::span(&empty, 1)));
  recordTransferToCompute(commands);
}

inline Descriptor wholeBuffer(uint32_t binding, const Buffer& buffer) {
  return {.binding = binding,
          .kind = DescriptorKind::kStorage,
          .buffer = &buffer,
          .size_bytes = buffer.sizeBytes()};
}

}  // namespace viewloom
