// SPDX-License-Identifier: Apache-2.0
// Records what reflected rays meet in several sources: each of their walks sends rays on from its
// own surfaces, and answers to all.
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "gpu/commands.h"
#include "gpu/compute_pass.h"
#include "picture/trace_job.h"
#include "shared/reflection_abi.h"
#include "structure/structure_slot.h"
#include "trace/albedos.h"

namespace viewloom {

// A piece of a band as one of the walks takes it.
struct PathPiece {
  const StructureSlot& structure;
  uint32_t rays = 0;  // abi::kRaysOf...
  BandRows rows;
  abi::TracePush push;             // of these rows, with the structure's own colour
  std::vector<Descriptor> params;  // of the walk: its tiles, its extras with the records, settings
  bool through_lens = false;
  Descriptor lens_points;
  Descriptor paths;    // abi::ReflectedPath per px
  Descriptor answers;  // abi::RayAnswer per px, written

  bool mirrors() const { return structure.surface() != nullptr; }
};

// What all walks answered to a piece, and where it goes.
struct MergedPaths {
  abi::MergePathsPush push;
  BandRows rows;
  Descriptor answers;  // of all walks
  Descriptor paths;
  Descriptor reflected;  // abi::ReflectedLight per px of the band, written
};

// The device must outlive it. Nothing is synchronised. Thread-safety: all methods may be called
// from any thread.
class PathReflector {
 public:
  explicit PathReflector(const Device& device) : device_(&device), albedos_(device) {}

  // From the surfaces of this walk that rays have met, or the first ones. It mirrors.
  void recordTurns(Commands commands, const PathPiece& piece);
  void recordWalk(Commands commands, const PathPiece& piece);
  void recordMerge(Commands commands, const MergedPaths& merged);

 private:
  struct WalkVariant {
    uint32_t reads_by_address;
    uint32_t color_format;
    uint32_t color_is_scaled;
    uint32_t is_cube_face;

    auto operator<=>(const WalkVariant&) const = default;
  };
  struct TurnVariant {
    uint32_t reads_by_address;
    uint32_t rays;  // abi::kRaysOf...
    uint32_t through_lens;

    auto operator<=>(const TurnVariant&) const = default;
  };

  const ComputePass& turnPass(const TurnVariant& variant);
  const ComputePass& walkPass(const WalkVariant& variant);
  const ComputePass& mergePass();

  const Device* device_;
  Albedos albedos_;
  std::mutex mutex_;  // guards what follows
  std::map<TurnVariant, std::unique_ptr<ComputePass>> turn_passes_;
  std::map<WalkVariant, std::unique_ptr<ComputePass>> walk_passes_;
  std::unique_ptr<ComputePass> merge_pass_;
};

}  // namespace viewloom
