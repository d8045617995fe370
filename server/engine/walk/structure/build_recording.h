// SPDX-License-Identifier: Apache-2.0
// Records the passes of a build.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/descriptor.h"
#include "structure/cut_recording.h"
#include "structure/structure_passes.h"
#include "structure/structure_slot.h"

namespace viewloom {

// So many groups hold so many invocations.
inline uint32_t groupsOf(uint32_t count, uint32_t group_size) {
  return (count + group_size - 1) / group_size;
}

// Bindings of passes over a slot.
std::vector<Descriptor> describeBindings(const StructureSlot& slot);

// One build, stage after stage. What it is made with outlives it. Thread-safety: none.
class BuildRecording {
 public:
  BuildRecording(CutRecording& recording, const StructureSlot& slot, const StructurePasses& passes,
                 const ComputePass& preparation)
      : recording_(recording),
        slot_(slot),
        passes_(passes),
        preparation_(preparation),
        bindings_(describeBindings(slot)) {}

  // Also the guard around the image.
  void prepare();
  void measure();
  // The device settles whether there is anything to do, and for which passes. Where that may take
  // long, the CPU asks first.
  void smooth();
  void buildFacets() { overBlocks(BuildPass::kFacets, passes_.build_facets, 1); }
  void buildBlocks() { overBlocks(BuildPass::kBlocks, passes_.build_blocks, 1); }
  void buildLevels();
  // Then the CPU may read StructureSlot::measuredHead().
  void readBackMeasured();

 private:
  // Groups of a pass. A row of them takes so many px, or nodes.
  struct Groups {
    uint32_t x = 1;
    uint32_t y = 1;
    uint32_t z = 1;
    uint64_t row_px_count = 1;
  };
  // Dispatches, with what the slot binds, and lets later passes see the result.
  void dispatch(BuildPass kind, const ComputePass& pass, abi::BuildPush push, const Groups& groups);
  // An invocation a node.
  void overNodes(BuildPass kind, const ComputePass& pass, uint32_t level, uint32_t layer_count,
                 uint64_t row_px_count);
  // The same of blocks of px; kernels that take whole columns dispatch one layer.
  void overBlocks(BuildPass kind, const ComputePass& pass, uint32_t layer_count);
  // Px of so many rows, of all layers.
  uint64_t pxOfRows(uint32_t row_count) const {
    return uint64_t{slot_.shape().depth_px.width} * row_count * slot_.shape().layerCount();
  }
  void smoothUnseen();
  void smoothInPieces();

  CutRecording& recording_;
  const StructureSlot& slot_;
  const StructurePasses& passes_;
  const ComputePass& preparation_;
  std::vector<Descriptor> bindings_;
};

}  // namespace viewloom
