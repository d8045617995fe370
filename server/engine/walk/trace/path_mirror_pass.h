// SPDX-License-Identifier: Apache-2.0
// Reflections in several sources: each walk sends rays on from its own surfaces, and all sources
// answer them.
#pragma once

#include <compare>
#include <span>
#include <vector>

#include "gpu/commands.h"
#include "gpu/pass_map.h"
#include "picture/trace_job.h"
#include "shared/reflection_abi.h"
#include "structure/structure_slot.h"
#include "trace/albedos.h"
#include "trace/band_rays.h"
#include "trace/join_pass.h"
#include "trace/trace_slot.h"

namespace viewloom {

// The device must outlive it, and the pass that it uses. Thread-safety: all methods may be called
// from any thread.
class PathMirrorPass {
 public:
  PathMirrorPass(const Device& device, JoinPass& join)
      : join_(join),
        albedos_(device),
        turn_passes_(device, makeTurnPass),
        walk_passes_(device, makeWalkPass),
        merge_pass_(device, makeMergePass) {}

  // Kernels that record() needs.
  void addMissing(std::span<const StructureSlot* const> structures, const TraceJob& job,
                  MissingKernels& missing);
  // Finds the light of rows of a part of the slot's band. What follows may read it.
  void record(Commands commands, std::span<const StructureSlot* const> structures,
              const TraceJob& job, BandRows rows, const BandPart& part, const TraceSlot& slot);

 private:
  struct TurnVariant {
    uint32_t reads_by_address;
    uint32_t rays;  // abi::kRaysOf...
    uint32_t through_lens;

    auto operator<=>(const TurnVariant&) const = default;
  };
  struct WalkVariant {
    uint32_t reads_by_address;
    uint32_t color_format;
    uint32_t color_is_scaled;
    uint32_t is_cube_face;

    auto operator<=>(const WalkVariant&) const = default;
  };
  // Rows of a band as one of the walks takes them.
  struct Piece;
  // Rows of a band or columns of one, and how what all walks answer to them lies in memory.
  struct Rows {
    const TraceJob& job;
    BandRows piece;
    GroupColumns columns;
    AnswerSpan answered;
    AnswersLayout answers;
    const TraceSlot& slot;
  };

  static ComputePass makeTurnPass(const Device& device, const TurnVariant& variant);
  static ComputePass makeWalkPass(const Device& device, const WalkVariant& variant);
  static ComputePass makeMergePass(const Device& device, const std::monostate&);
  static TurnVariant turnVariantOf(const StructureSlot& structure, const TraceJob& job);
  static WalkVariant walkVariantOf(const StructureSlot& structure);
  std::vector<Piece> describe(std::span<const StructureSlot* const> structures, const Rows& rows,
                              const BandRays& rays, uint32_t band_row);
  void recordBounce(Commands commands, std::span<Piece> pieces, const Rows& rows,
                    const abi::MergePathsPush& push);

  JoinPass& join_;
  Albedos albedos_;
  PassMap<TurnVariant> turn_passes_;
  PassMap<WalkVariant> walk_passes_;
  SinglePass merge_pass_;
};

}  // namespace viewloom
