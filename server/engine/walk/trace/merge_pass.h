// SPDX-License-Identifier: Apache-2.0
// Rays in several structures: all of those answer, and the px follow from all answers.
#pragma once

#include <compare>
#include <span>

#include "gpu/commands.h"
#include "gpu/pass_map.h"
#include "trace/band_rays.h"
#include "trace/join_pass.h"
#include "trace/trace_slot.h"
#include "trace/walk_pass.h"

namespace viewloom {

// The device must outlive it, and the passes that it uses. Thread-safety: all methods may be called
// from any thread.
class MergePass {
 public:
  MergePass(const Device& device, WalkPass& walk, JoinPass& join)
      : walk_(walk), join_(join), passes_(device, makePass) {}

  // Kernels that record() needs.
  void addMissing(std::span<const StructureSlot* const> structures, const TraceJob& job,
                  const BandRays& rays, MissingKernels& missing);
  // One ray of each px of a part of the slot's band, as far as the part has their walks, and merges
  // them. What follows may read the px.
  void record(Commands commands, std::span<const StructureSlot* const> structures,
              const TraceJob& job, BandRows rows, const BandPart& part, const BandRays& rays,
              const TraceSlot& slot);
  // Rays of such a part that are walked: there are none in faces of cube maps that none enters.
  static uint64_t rayCount(std::span<const StructureSlot* const> structures, const TraceJob& job,
                           const BandPart& part);

 private:
  struct Variant {
    uint32_t wanted;  // abi::kWant... flags
    uint32_t rays;    // abi::kRaysOf...

    auto operator<=>(const Variant&) const = default;
  };

  static ComputePass makePass(const Device& device, const Variant& variant);
  static Variant variantOf(const TraceJob& job, const BandRays& rays);
  // Those of walks [first, end) that may see something, a bit each.
  struct Walks {
    uint32_t first = 0;
    uint32_t end = 0;
  };
  static uint64_t walksOf(std::span<const StructureSlot* const> structures, const TraceJob& job,
                          const BandRays& rays, Walks of);
  // Rows of a band whose answers lie in memory at once.
  struct Piece;
  void recordWalks(Commands commands, const Piece& piece, const BandPart& part,
                   const BandRays& rays);
  void recordMerge(Commands commands, const Piece& piece, const BandPart& part,
                   const BandRays& rays);

  WalkPass& walk_;
  JoinPass& join_;
  PassMap<Variant> passes_;
};

}  // namespace viewloom
