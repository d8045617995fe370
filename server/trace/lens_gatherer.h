// SPDX-License-Identifier: Apache-2.0
// Records the second stage of a lens: more rays of each px, compared with the surfaces that its
// block's walked rays met.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "gpu/compute_pass.h"
#include "structure/structure_slot.h"
#include "trace/met_blocks.h"
#include "trace/trace_job.h"

namespace viewloom {

// What is read and written beside the structure.
struct GatherTarget {
  const Buffer& met;    // what the walked rays met: uint32_t[sample][row][width]
  const Buffer& lists;  // of metListsBytes()
  const Buffer& sums;   // the mean of the walked rays: linear light, float[3] per px
  const Buffer& band;   // written: R, G, B, 255, uint32_t per px
  bool wants_linear = false;
};

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class LensGatherer {
 public:
  explicit LensGatherer(const Device& device) : device_(&device) {}

  // `color`: of the structure, opaque. `params`: the views and the extras, as for the walk. Waits
  // for the compute work before it.
  void record(vk::CommandBuffer commands, const StructureSlot& structure,
              const LayeredBuffer& color, uint32_t color_format, const TraceJob& job, BandRows rows,
              const std::vector<Descriptor>& params, const GatherTarget& target);

 private:
  struct Variant {
    uint32_t reads_by_address;
    uint32_t wanted;
    uint32_t color_format;
    uint32_t color_is_scaled;
    uint32_t is_exact;

    auto operator<=>(const Variant&) const = default;
  };

  const ComputePass& listPass();
  const ComputePass& gatherPass(const Variant& variant);

  const Device* device_;
  std::mutex mutex_;  // guards what follows
  std::unique_ptr<ComputePass> list_pass_;
  std::map<Variant, std::unique_ptr<ComputePass>> gather_passes_;
};

}  // namespace viewloom
