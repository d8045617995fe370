// SPDX-License-Identifier: Apache-2.0
#include "trace/view_tracer.h"

#include "gpu/commands.h"
#include "trace/band_params.h"

namespace viewloom {

ViewTracer::ViewTracer(const Device& device)
    : device_(device),
      mean_color_(device),
      walk_(device, mean_color_),
      join_(device),
      merge_(device, walk_, join_),
      lens_(device, mean_color_),
      mirror_(device),
      path_mirror_(device, join_),
      mirrored_light_(device),
      blend_(device),
      pack_(device) {}

// A software device has nothing to read back, and packing px costs it more than converting them
// costs the encoder (shaders/color.md, Bands for the encoder).
ColorForm ViewTracer::colorForm(ColorForm wanted) const {
  return device_.info().is_software ? ColorForm::kRgba : wanted;
}

MissingKernels ViewTracer::missing(std::span<const StructureSlot* const> structures,
                                   const TraceJob& job, const TraceOutputs& outputs) {
  const StructureSlot& first = *structures.front();
  MissingKernels missing;
  for (const BandRays& rays : raysOfPart(job, first, outputs, {.end_sample = job.sample_count})) {
    if (job.walk_count == 1) {
      walk_.addMissing({first, job, 0, rays}, missing);
    } else {
      merge_.addMissing(structures, job, rays, missing);
    }
  }
  if (gathersOnDevice(job, first)) {
    lens_.addMissing(first, job, outputs.linear, missing);
  } else if (job.sumsLight()) {
    blend_.addMissing(missing);
  }
  if (job.reflects()) {
    if (job.walk_count == 1) {
      mirror_.addMissing(first, job, missing);
    } else {
      path_mirror_.addMissing(structures, job, missing);
    }
    mirrored_light_.addMissing(missing);
  }
  if (outputs.color != ColorForm::kRgba) pack_.addMissing(outputs.color, missing);
  return missing;
}

void ViewTracer::recordBand(Commands commands, std::span<const StructureSlot* const> structures,
                            const TraceJob& job, BandRows rows, TraceSlot& slot, GpuTimer* timer) {
  if (timer) timer->recordBegin(commands, "trace");
  for (BandParts parts = partsOf(structures, job, rows); !parts.isOver();) {
    recordPart(commands, structures, job, rows, parts.take(), slot);
  }
  if (timer) timer->recordEnd(commands);
}

void ViewTracer::recordPart(Commands commands, std::span<const StructureSlot* const> structures,
                            const TraceJob& job, BandRows rows, const BandPart& part,
                            TraceSlot& slot) {
  const StructureSlot& first = *structures.front();
  if (part.is_first) slot.recordBegin(commands, structures, job, rows);
  if (job.gathers_on_host) recordEmptyList(commands, slot.incomplete());
  if (part.kind == PartKind::kReflect) {
    recordReflections(commands, structures, job, rows, part, slot);
  }
  for (const BandRays& rays : raysOfPart(job, first, slot.shape().outputs, part)) {
    recordRays(commands, structures, job, rows, part, rays, slot);
    const bool is_middle = job.hasLens() && !rays.through_lens;
    if (is_middle || gathersOnDevice(job, first)) recordComputeBarrier(commands);
    if (part.settles && !is_middle) {
      recordSettling(commands, first, job, rows, {0, rows.row_count}, rays.sample, slot);
    }
  }
  if (part.kind == PartKind::kSettle) {
    recordSettling(commands, first, job, rows, {part.first_row, part.end_row}, part.first_sample,
                   slot);
  }
  if (part.kind == PartKind::kGather && gathersOnDevice(job, first)) {
    lens_.record(commands, first, job, rows, part, slot);
  }
  if (!part.is_last) return;
  const ColorForm form = slot.shape().outputs.color;
  if (form != ColorForm::kRgba) {
    pack_.record(commands, slot.rgba(), slot.colorTarget(), slot.bandSize_px(), form);
  }
  slot.recordReadback(commands);
}

uint64_t ViewTracer::recordMeans(Commands commands,
                                 std::span<const StructureSlot* const> structures,
                                 const TraceJob& job, const TraceOutputs& outputs,
                                 uint64_t texel_count_max) {
  for (const BandRays& rays :
       raysOfPart(job, *structures.front(), outputs, {.end_sample = job.sample_count})) {
    for (uint32_t walk = 0; walk < job.walk_count; ++walk) {
      const uint64_t texel_count =
          walk_.recordMeans(commands, {*structures[walk], job, walk, rays}, texel_count_max);
      if (texel_count > 0) return texel_count;
    }
  }
  return 0;
}

void ViewTracer::recordRays(Commands commands, std::span<const StructureSlot* const> structures,
                            const TraceJob& job, BandRows rows, const BandPart& part,
                            const BandRays& rays, const TraceSlot& slot) {
  if (job.walk_count > 1) {
    merge_.record(commands, structures, job, rows, part, rays, slot);
    return;
  }
  const Descriptor target = wholeBuffer(abi::kBindingBand, slot.sampleTarget(job));
  walk_.record(
      commands, {*structures.front(), job, 0, rays}, rows,
      {.rows = {part.first_row, part.end_row}, .columns = {part.first_column, part.end_column}},
      slot, target);
}

// Rays that are walked for the second stage of a lens add their light, and leave what they met:
// blocks where a round of them met nothing new have no more of them. The second stage makes px of
// the sums. Mirrored light is added to px before they are blended.
void ViewTracer::recordSettling(Commands commands, const StructureSlot& structure,
                                const TraceJob& job, BandRows rows, RowSpan span, uint32_t sample,
                                const TraceSlot& slot) {
  if (gathersOnDevice(job, structure)) {
    const MetRound round = metRound(sample, job.sample_count);
    if (sample + 1 < round.end) return;
    lens_.recordLists(commands, structure, job, rows, span, slot, round);
    return;
  }
  if (job.reflects()) {
    mirrored_light_.record(commands, job,
                           {.rows = rows,
                            .reflected = slot.reflected(),
                            .rgba = slot.sampleTarget(job),
                            // The mean of several samples is made of their codes.
                            .linear_address = job.sample_count == 1 ? slot.linearAddress() : 0,
                            .span = span});
  }
  if (job.sumsLight()) recordBlend(commands, job, span, sample, slot);
}

// Records reflections for px whose rays are known.
void ViewTracer::recordReflections(Commands commands,
                                   std::span<const StructureSlot* const> structures,
                                   const TraceJob& job, BandRows rows, const BandPart& part,
                                   const TraceSlot& slot) {
  if (job.walk_count == 1) {
    mirror_.record(commands, {*structures.front(), job, 0, {.sample = part.first_sample}}, rows,
                   part, slot);
  } else {
    path_mirror_.record(commands, structures, job, rows, part, slot);
  }
  if (!part.settles) return;
  recordSettling(commands, *structures.front(), job, rows, {0, rows.row_count}, part.first_sample,
                 slot);
}

void ViewTracer::recordBlend(Commands commands, const TraceJob& job, RowSpan span, uint32_t sample,
                             const TraceSlot& slot) {
  const SizePx band_px = slot.bandSize_px();
  blend_.record(commands,
                {.sample = slot.sampleTarget(job),
                 .sums = slot.sums(),
                 .band = slot.rgba(),
                 .linear_address = slot.linearAddress(),
                 .px_count = uint32_t(band_px.area()),
                 .first_px = span.first * band_px.width,
                 .end_px = span.end * band_px.width},
                job.layout->samples, sample);
}

}  // namespace viewloom
