// SPDX-License-Identifier: Apache-2.0
// Records the trace of bands of an atlas by the walk.
#pragma once

#include <span>

#include "gpu/commands.h"
#include "gpu/gpu_timer.h"
#include "gpu/pass_map.h"
#include "picture/trace_job.h"
#include "structure/structure_slot.h"
#include "trace/band_parts.h"
#include "trace/blend_pass.h"
#include "trace/join_pass.h"
#include "trace/lens_pass.h"
#include "trace/mean_color_pass.h"
#include "trace/merge_pass.h"
#include "trace/mirror_pass.h"
#include "trace/pack_pass.h"
#include "trace/path_mirror_pass.h"
#include "trace/trace_slot.h"
#include "trace/walk_pass.h"

namespace viewloom {

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class ViewTracer {
 public:
  explicit ViewTracer(const Device& device);

  // The form in which colour leaves the device best: the one that is wanted, where it has to be
  // read back.
  ColorForm colorForm(ColorForm wanted) const;

  // Kernels that bands of this job need and nobody has compiled. With them, recording a band
  // compiles nothing; without, it compiles what it needs. The structures' build is done.
  MissingKernels missing(std::span<const StructureSlot* const> structures, const TraceJob& job,
                         const TraceOutputs& outputs);

  // Traces these rows of the job's atlas into the slot. The slot holds the width, the rows, the
  // tiles and the walks, of which the job has as many as there are structures. Their build is
  // done, not only recorded: its stats choose the kernels. `timer` was reset in this recording;
  // nullptr = untimed.
  void recordBand(Commands commands, std::span<const StructureSlot* const> structures,
                  const TraceJob& job, BandRows rows, TraceSlot& slot, GpuTimer* timer);
  void recordBand(Commands commands, const StructureSlot& structure, const TraceJob& job,
                  BandRows rows, TraceSlot& slot, GpuTimer* timer) {
    const StructureSlot* const structures[] = {&structure};
    recordBand(commands, structures, job, rows, slot, timer);
  }
  // The same part by part, all of them in their order, each in a submission of its own if wanted.
  // Nothing else may use the slot meanwhile.
  static BandParts partsOf(std::span<const StructureSlot* const> structures, const TraceJob& job,
                           BandRows rows) {
    return {job, rows, gathersOnDevice(job, *structures.front())};
  }
  // Rays of a part that are to be traced: no more than it counts.
  static uint64_t rayCount(std::span<const StructureSlot* const> structures, const TraceJob& job,
                           const BandPart& part) {
    return part.walks() && job.walk_count > 1 ? MergePass::rayCount(structures, job, part)
                                              : part.ray_count;
  }
  void recordPart(Commands commands, std::span<const StructureSlot* const> structures,
                  const TraceJob& job, BandRows rows, const BandPart& part, TraceSlot& slot);
  // Records some of the means of colour that the job's bands take, of about so many texels. Returns
  // how many; 0 = there are all. Parts make what is left of them in one go.
  uint64_t recordMeans(Commands commands, std::span<const StructureSlot* const> structures,
                       const TraceJob& job, const TraceOutputs& outputs, uint64_t texel_count_max);

 private:
  void recordRays(Commands commands, std::span<const StructureSlot* const> structures,
                  const TraceJob& job, BandRows rows, const BandPart& part, const BandRays& rays,
                  const TraceSlot& slot);
  // Adds what is known of a sample to what is known of the others, in some rows of the band.
  void recordSettling(Commands commands, const StructureSlot& structure, const TraceJob& job,
                      BandRows rows, RowSpan span, uint32_t sample, const TraceSlot& slot);
  void recordReflections(Commands commands, std::span<const StructureSlot* const> structures,
                         const TraceJob& job, BandRows rows, const BandPart& part,
                         const TraceSlot& slot);
  void recordBlend(Commands commands, const TraceJob& job, RowSpan span, uint32_t sample,
                   const TraceSlot& slot);

  const Device& device_;
  MeanColorPass mean_color_;
  WalkPass walk_;
  JoinPass join_;
  MergePass merge_;
  LensPass lens_;
  MirrorPass mirror_;
  PathMirrorPass path_mirror_;
  MirroredLightPass mirrored_light_;
  BlendPass blend_;
  PackPass pack_;
};

}  // namespace viewloom
