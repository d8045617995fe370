// SPDX-License-Identifier: Apache-2.0
// Records the trace of bands of an atlas by the walk.
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <mutex>

#include "gpu/compute_pass.h"
#include "gpu/gpu_timer.h"
#include "structure/structure_slot.h"
#include "trace/band_packer.h"
#include "trace/trace_job.h"
#include "trace/trace_slot.h"

namespace viewloom {

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class ViewTracer {
 public:
  explicit ViewTracer(const Device& device);

  // The form in which colour leaves the device best: the one that is wanted, where it has to be
  // read back.
  ColorForm colorForm(ColorForm wanted) const;

  // Traces these rows of the job's atlas into the slot. The slot holds the width, the rows and the
  // tiles. The structure's build is done, not only recorded: its stats choose the kernel. `timer`
  // was reset in this recording; nullptr = untimed. The first band of a new variant compiles its
  // pipeline.
  void recordBand(vk::CommandBuffer commands, const StructureSlot& structure, const TraceJob& job,
                  BandRows rows, TraceSlot& slot, GpuTimer* timer);

 private:
  // What the pipeline is specialised to.
  struct Variant {
    uint32_t reads_by_address;
    uint32_t wanted;  // abi::kWant... flags
    uint32_t color_format;
    uint32_t pixels_per_invocation;
    uint32_t lanes_are_views;
    uint32_t color_is_scaled;
    uint32_t rays_are_plain;
    uint32_t eyes_in_plane;

    auto operator<=>(const Variant&) const = default;
  };

  static abi::TraceExtras describeExtras(const StructureSlot& structure, const TraceSlot& slot);
  static std::vector<Descriptor> describeBindings(const StructureSlot& structure,
                                                  const TraceSlot& slot, uint64_t tiles_bytes);
  static abi::TracePush describeBand(const StructureSlot& structure, const TraceJob& job,
                                     BandRows rows);
  const ComputePass& pass(const Variant& variant);

  const Device* device_;
  std::mutex mutex_;  // guards passes_
  std::map<Variant, std::unique_ptr<ComputePass>> passes_;
  BandPacker packer_;
};

}  // namespace viewloom
