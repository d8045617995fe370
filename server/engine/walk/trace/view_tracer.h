// SPDX-License-Identifier: Apache-2.0
// Records the trace of bands of an atlas by the walk.
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "gpu/commands.h"
#include "gpu/compute_pass.h"
#include "gpu/gpu_timer.h"
#include "picture/trace_job.h"
#include "structure/structure_slot.h"
#include "trace/band_packer.h"
#include "trace/band_parts.h"
#include "trace/color_averager.h"
#include "trace/lens_gatherer.h"
#include "trace/path_reflector.h"
#include "trace/reflector.h"
#include "trace/sample_blender.h"
#include "trace/trace_slot.h"

namespace viewloom {

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class ViewTracer {
 public:
  explicit ViewTracer(const Device& device);

  // The form in which colour leaves the device best: the one that is wanted, where it has to be
  // read back.
  ColorForm colorForm(ColorForm wanted) const;

  // Traces these rows of the job's atlas into the slot. The slot holds the width, the rows, the
  // tiles and the walks, of which the job has as many as there are structures. Their build is
  // done, not only recorded: its stats choose the kernels. `timer` was reset in this recording;
  // nullptr = untimed. The first band of a new variant compiles its pipeline.
  void recordBand(Commands commands, std::span<const StructureSlot* const> structures,
                  const TraceJob& job, BandRows rows, TraceSlot& slot, GpuTimer* timer);
  void recordBand(Commands commands, const StructureSlot& structure, const TraceJob& job,
                  BandRows rows, TraceSlot& slot, GpuTimer* timer) {
    const StructureSlot* const structures[] = {&structure};
    recordBand(commands, structures, job, rows, slot, timer);
  }
  // The same part by part (BandParts), all of them in their order, each in a submission of its own
  // if wanted. Nothing else may use the slot meanwhile.
  void recordPart(Commands commands, std::span<const StructureSlot* const> structures,
                  const TraceJob& job, BandRows rows, uint32_t part, TraceSlot& slot);

 private:
  // What the pipeline is specialised to.
  struct Variant {
    bool reads_by_address;
    uint32_t wanted;  // abi::kWant... flags
    uint32_t color_format;
    uint32_t pixels_per_invocation;
    bool lanes_are_views;
    bool color_is_scaled;
    bool rays_are_plain;
    bool eyes_in_plane;
    bool is_one_of_several;
    bool is_cube_face;
    uint32_t rays;          // abi::kRaysOf...
    uint32_t shown_beside;  // abi::kShows... flags that some tile has
    bool through_lens;
    bool is_of_blocks;
    bool lists_hidden;
    uint32_t rays_of_hidden;
    bool lists_unfinished;

    auto operator<=>(const Variant&) const = default;
  };

  // One ray of each px.
  struct Rays {
    uint32_t sample = 0;
    bool through_lens = false;
    uint32_t wanted = 0;        // abi::kWant... flags
    bool is_of_blocks = false;  // of px in blocks that are not complete alone
    bool lists_hidden = false;  // px whose ray ends behind something
    // Not 0: the mean of so many rays through the lens, of px that are listed alone; alpha 0.
    uint32_t count_of_hidden = 0;

    // Whether they are those of px or blocks on the slot's list of what is incomplete.
    bool areListed() const { return is_of_blocks || count_of_hidden > 0; }
  };

  // One of the walks of a job, and where its answers go.
  struct Walk {
    const StructureSlot& structure;
    const TraceJob& job;
    uint32_t index;
    Rays rays;
    const TraceSlot& slot;
    Descriptor target;
  };

  static abi::TraceExtras describeExtras(const StructureSlot& structure, const TraceJob& job,
                                         uint32_t part, const TraceSlot& slot);
  static void fillParams(std::span<const StructureSlot* const> structures, const TraceJob& job,
                         TraceSlot& slot);
  static std::vector<Descriptor> describeParams(const TraceJob& job, uint32_t walk, uint32_t sample,
                                                const TraceSlot& slot);
  static abi::TracePush describeBand(const Walk& walk, const LayeredBuffer& color, BandRows rows);
  Variant variantOf(const Walk& walk, uint32_t color_format) const;
  void recordWalk(Commands commands, const Walk& walk, BandRows rows);
  void recordReflections(Commands commands, std::span<const StructureSlot* const> structures,
                         const TraceJob& job, BandRows rows, const BandPart& part, TraceSlot& slot);
  void recordMirrors(Commands commands, const Walk& walk, BandRows rows, const BandPart& part);
  static ReflectedTarget reflectedTarget(const TraceJob& job, BandRows rows, const TraceSlot& slot);
  static std::vector<Descriptor> describeReflected(const Walk& walk, uint32_t first_walk);
  static std::vector<PathPiece> describePaths(std::span<const StructureSlot* const> structures,
                                              const TraceJob& job, BandRows piece, const Rays& rays,
                                              const AnswersLayout& answers, const TraceSlot& slot);
  void recordBounce(Commands commands, std::span<PathPiece> pieces, const TraceJob& job,
                    const AnswersLayout& answers, const MergedPaths& merged, const TraceSlot& slot);
  void recordPaths(Commands commands, std::span<const StructureSlot* const> structures,
                   const TraceJob& job, BandRows rows, const BandPart& part, const TraceSlot& slot);
  void recordMerged(Commands commands, std::span<const StructureSlot* const> structures,
                    const TraceJob& job, BandRows rows, const Rays& rays, TraceSlot& slot);
  void recordRays(Commands commands, std::span<const StructureSlot* const> structures,
                  const TraceJob& job, BandRows rows, const Rays& rays, TraceSlot& slot);
  void beginBand(Commands commands, std::span<const StructureSlot* const> structures,
                 const TraceJob& job, BandRows rows, TraceSlot& slot);
  void endBand(Commands commands, TraceSlot& slot);
  void recordSamples(Commands commands, std::span<const StructureSlot* const> structures,
                     const TraceJob& job, BandRows rows, const BandPart& part, TraceSlot& slot);
  void recordMiddleRays(Commands commands, std::span<const StructureSlot* const> structures,
                        const TraceJob& job, BandRows rows, uint32_t wanted, TraceSlot& slot);
  void recordLensSamples(Commands commands, const StructureSlot& structure, const TraceJob& job,
                         BandRows rows, const BandPart& part, TraceSlot& slot);
  uint64_t recordWalks(Commands commands, std::span<const StructureSlot* const> structures,
                       const TraceJob& job, BandRows piece, const Rays& rays,
                       const AnswersLayout& answers, const TraceSlot& slot);
  void recordJoins(Commands commands, const TraceJob& job, uint64_t walked, uint32_t answer_count,
                   const AnswersLayout& answers, const TraceSlot& slot);
  const ComputePass& pass(const Variant& variant);
  const ComputePass& mergePass(uint32_t wanted, uint32_t rays);
  const ComputePass& joinPass();

  const Device* device_;
  std::mutex mutex_;  // guards what follows
  std::map<Variant, std::unique_ptr<ComputePass>> passes_;
  ColorAverager averager_;
  BandPacker packer_;
  SampleBlender blender_;
  LensGatherer gatherer_;
  Reflector reflector_;
  PathReflector path_reflector_;
  // By abi::kWant... flags and abi::kRaysOf...
  std::map<std::pair<uint32_t, uint32_t>, std::unique_ptr<ComputePass>> merge_passes_;
  std::unique_ptr<ComputePass> join_pass_;
};

}  // namespace viewloom
