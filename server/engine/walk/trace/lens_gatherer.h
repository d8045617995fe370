// SPDX-License-Identifier: Apache-2.0
// Records the second stage of a lens: more rays of each px, compared with the surfaces that its
// block's walked rays met.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "gpu/commands.h"
#include "gpu/compute_pass.h"
#include "picture/trace_job.h"
#include "structure/structure_slot.h"
#include "trace/met_blocks.h"

namespace viewloom {

// What the walked rays of a band met.
struct MetTarget {
  const Buffer& met;         // of each ray: uint32_t[sample][row][width]
  const Buffer& lists;       // of metListsBytes()
  const Buffer& incomplete;  // abi::IncompleteHead, and room for all blocks
};

// What is read and written beside the structure.
struct GatherTarget {
  const Buffer& lists;
  const Buffer& sums;  // of the walked rays: linear light, float[3] per px
  const Buffer& band;  // written: R, G, B, 255, uint32_t per px
  bool wants_linear = false;
};

// Rows of a band, of which some are gathered. The first come first.
struct GatherRows {
  BandRows band;
  uint32_t first_row = 0;  // of the band
  uint32_t end_row = 0;
};

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class LensGatherer {
 public:
  explicit LensGatherer(const Device& device) : device_(&device) {}

  // Lists what a round of rays met, and the blocks that are not complete by it. `views`: as for the
  // walk. Waits for the compute work before it, and what follows waits for it.
  void recordLists(Commands commands, const StructureSlot& structure, const TraceJob& job,
                   BandRows rows, const Descriptor& views, const MetTarget& target, MetRound round);
  // `color`: of the structure, opaque. `params`: the views, the extras and all points of the lens,
  // as for the walk. Waits as above.
  void record(Commands commands, const StructureSlot& structure, const LayeredBuffer& color,
              uint32_t color_format, const TraceJob& job, const GatherRows& rows,
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

  const ComputePass& listPass(bool reads_by_address);
  const ComputePass& gatherPass(const Variant& variant);

  const Device* device_;
  std::mutex mutex_;  // guards what follows
  std::map<bool, std::unique_ptr<ComputePass>> list_passes_;
  std::map<Variant, std::unique_ptr<ComputePass>> gather_passes_;
};

}  // namespace viewloom
