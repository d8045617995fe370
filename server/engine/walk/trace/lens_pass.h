// SPDX-License-Identifier: Apache-2.0
// Records the second stage of a lens: more rays of each px, compared with the surfaces that its
// block's walked rays met.
#pragma once

#include <compare>
#include <cstdint>

#include "gpu/commands.h"
#include "gpu/pass_map.h"
#include "picture/trace_job.h"
#include "structure/structure_slot.h"
#include "trace/band_parts.h"
#include "trace/band_rays.h"
#include "trace/mean_color_pass.h"
#include "trace/met_blocks.h"
#include "trace/trace_slot.h"

namespace viewloom {

// The device must outlive it, and the pass that it uses. Thread-safety: all methods may be called
// from any thread.
class LensPass {
 public:
  LensPass(const Device& device, MeanColorPass& mean_color)
      : mean_color_(mean_color),
        list_passes_(device, makeListPass),
        gather_passes_(device, makeGatherPass) {}

  // Kernels that the following need.
  void addMissing(const StructureSlot& structure, const TraceJob& job, bool wants_linear,
                  MissingKernels& missing);
  // Lists what a round of rays met in some rows of a band, and the blocks that are not complete by
  // it. Spans come from the top down: the first one empties the list. Waits for the compute work
  // before it, and what follows waits for it.
  void recordLists(Commands commands, const StructureSlot& structure, const TraceJob& job,
                   BandRows rows, RowSpan span, const TraceSlot& slot, MetRound round);
  // Gathers rows of the slot's band, once all rounds are listed. Waits as above.
  void record(Commands commands, const StructureSlot& structure, const TraceJob& job, BandRows rows,
              const BandPart& part, const TraceSlot& slot);

 private:
  struct ListVariant {
    uint32_t reads_by_address;

    auto operator<=>(const ListVariant&) const = default;
  };
  struct GatherVariant {
    uint32_t reads_by_address;
    uint32_t wanted;
    uint32_t color_format;
    uint32_t color_is_scaled;
    uint32_t is_exact;

    auto operator<=>(const GatherVariant&) const = default;
  };

  static ComputePass makeListPass(const Device& device, const ListVariant& variant);
  static ComputePass makeGatherPass(const Device& device, const GatherVariant& variant);
  static GatherVariant variantOf(const StructureSlot& structure, const TraceJob& job,
                                 bool wants_linear);

  MeanColorPass& mean_color_;
  PassMap<ListVariant> list_passes_;
  PassMap<GatherVariant> gather_passes_;
};

}  // namespace viewloom
