// SPDX-License-Identifier: Apache-2.0
// Parameters of the rays of a band, on the device: of each walk of each sample its abi::TraceExtras
// and its tiles, and the points of the lens.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/descriptor.h"
#include "picture/trace_job.h"
#include "shared/trace_abi.h"
#include "structure/structure_slot.h"
#include "trace/trace_slot_shape.h"

namespace viewloom {

// Alignment that suffices for descriptors of any device.
inline constexpr uint64_t kDescriptorAlignment_bytes = 256;

// Addresses of what rays write beside colour; 0 = not wanted.
struct TracedPlanes {
  uint64_t depth = 0;
  uint64_t mask = 0;
  uint64_t linear = 0;
  uint64_t records = 0;
  uint64_t counters = 0;
  uint64_t met = 0;               // of the first sample
  uint64_t met_stride_bytes = 0;  // from sample to sample
};

// The device must outlive it. Thread-safety: none; as the slot that it is of.
class TraceParams {
 public:
  TraceParams(const Device& device, const TraceSlotShape& shape);

  // Bytes of the upload; the device has a copy.
  static uint64_t uploadBytesFor(const TraceSlotShape& shape);
  uint64_t sizeBytes() const { return upload_.sizeBytes() + params_.sizeBytes(); }
  // For the job's band; what is recorded next brings it to the device.
  void write(std::span<const StructureSlot* const> structures, const TraceJob& job,
             const TracedPlanes& planes);
  void recordUpload(Commands commands, const TraceJob& job) const;

  // The tiles and the extras of a walk of a sample.
  std::vector<Descriptor> of(const TraceJob& job, uint32_t walk, uint32_t sample) const;
  // The lens points of a sample and of those after it; without a lens, nothing that is read.
  Descriptor lensPoints(const TraceJob& job, uint32_t sample) const;

 private:
  Buffer upload_;
  Buffer params_;  // the same, on the device
};

}  // namespace viewloom
