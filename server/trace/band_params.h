// SPDX-License-Identifier: Apache-2.0
// What the passes over a band tell their kernels, in the form in which they take it.
#pragma once

#include "gpu/descriptor.h"
#include "shared/trace_abi.h"
#include "trace/trace_job.h"

namespace viewloom {

inline uint32_t wantedFlags(const TraceOutputs& outputs) {
  return (outputs.depth ? abi::kWantDepth : 0) | (outputs.mask ? abi::kWantMask : 0) |
         (outputs.linear ? abi::kWantLinear : 0) | (outputs.records ? abi::kWantRecords : 0);
}

// Of the first of several samples of a px; the others leave their colour alone, and what is needed
// on the way.
inline uint32_t wantedOf(const TraceJob& job, uint32_t sample, const TraceOutputs& outputs) {
  if (job.walk_count > 1) return 0;
  return (sample > 0 ? 0 : wantedFlags(outputs)) | (job.reflects() ? abi::kWantRecords : 0);
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

inline Descriptor wholeBuffer(uint32_t binding, const Buffer& buffer) {
  return {.binding = binding,
          .kind = DescriptorKind::kStorage,
          .buffer = buffer.handle(),
          .size_bytes = buffer.sizeBytes()};
}

}  // namespace viewloom
