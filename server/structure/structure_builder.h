// SPDX-License-Identifier: Apache-2.0
// Records the build of a structure: linearise, measure, facets, links, pyramid.
#pragma once

#include <span>
#include <vector>

#include "gpu/compute_pass.h"
#include "gpu/gpu_timer.h"
#include "structure/structure_slot.h"

namespace viewloom {

// Passes a recording times at most.
inline constexpr uint32_t kStructurePassCountMax = 16;

// The device must outlive it. Thread-safety: record() may be called from one thread at a time.
class StructureBuilder {
 public:
  explicit StructureBuilder(const Device& device);

  // From uploaded planes to a structure that can be traced, and its stats in host memory. Commands
  // recorded afterwards in the same submission see it, too. `timer` was reset in this recording;
  // nullptr = untimed.
  void record(vk::CommandBuffer commands, const StructureSlot& slot, GpuTimer* timer) const;

 private:
  void recordColor(vk::CommandBuffer commands, const StructureSlot& slot) const;
  void recordLinearise(vk::CommandBuffer commands, const StructureSlot& slot) const;
  void recordPyramid(vk::CommandBuffer commands, const StructureSlot& slot, GpuTimer* timer) const;

  // Passes over whole columns unroll their loops: one pipeline per layer count.
  using PerLayerCount = std::vector<ComputePass>;  // [layer count - 1]
  static PerLayerCount makePerLayerCount(const Device& device, std::span<const uint32_t> spirv,
                                         const char* name);

  ComputePass convert_color_;
  std::vector<ComputePass> linearise_depth_;  // [abi::kDepthSample...]
  PerLayerCount sort_columns_;
  ComputePass measure_depth_;
  ComputePass settle_tolerance_;
  PerLayerCount build_facets_;
  PerLayerCount build_links_;
  ComputePass build_blocks_;
  ComputePass build_level_;
  ComputePass flatten_entries_;
};

}  // namespace viewloom
