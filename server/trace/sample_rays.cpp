// SPDX-License-Identifier: Apache-2.0
// The rays of each px: one, or several whose light is averaged.
#include <optional>

#include "gpu/barrier.h"
#include "trace/band_params.h"
#include "trace/view_tracer.h"

namespace viewloom {

void ViewTracer::recordRays(vk::CommandBuffer commands,
                            std::span<const StructureSlot* const> structures, const TraceJob& job,
                            BandRows rows, const Rays& rays, TraceSlot& slot) {
  if (job.walk_count == 1) {
    const Descriptor band = wholeBuffer(abi::kBindingBand, slot.sampleTarget(job));
    recordWalk(commands, {*structures[0], job, 0, rays, slot, band}, rows);
  } else {
    recordMerged(commands, structures, job, rows, rays, slot);
  }
}

void ViewTracer::recordSamples(vk::CommandBuffer commands,
                               std::span<const StructureSlot* const> structures,
                               const TraceJob& job, BandRows rows, TraceSlot& slot) {
  BlendTarget blended{
      .sample = slot.sampleTarget(job),
      .sums = slot.sums_,
      .band = slot.rgba(),
      .linear_address = slot.linear_.isEmpty() ? 0 : slot.linear_.target().address(),
      .px_count = uint32_t(slot.band_px_.area())};
  // What else is wanted than colour is that of the ray through the middle of px and lens.
  const uint32_t wanted = wantedFlags(slot.shape_.outputs);
  const bool has_middle_apart = job.hasLens() && (wanted & ~abi::kWantLinear) != 0;
  if (has_middle_apart) {
    recordRays(commands, structures, job, rows, {.wanted = wanted & ~abi::kWantLinear}, slot);
    recordComputeBarrier(commands);
  }
  std::optional<ColorAverager::Color> gathered;
  if (job.mayGather()) {
    const TileRays rays = raysOf(job, 0, 0);
    gathered.emplace(
        averager_.record(commands, *structures[0], colorReach(rays.tiles, rays.tile_px)));
    // What is seen through has no single surface to compare with.
    if (gathered->format == abi::kColorRgba16f) gathered.reset();
  }
  blended.has_more = gathered.has_value();
  for (uint32_t sample = 0; sample < job.sample_count; ++sample) {
    const uint32_t of_first = sample == 0 && !has_middle_apart ? wanted : 0;
    const Rays rays{.sample = sample,
                    .through_lens = job.hasLens(),
                    .wanted = of_first | (gathered ? abi::kWantMet : 0) |
                              (job.reflects() ? abi::kWantRecords : 0)};
    recordRays(commands, structures, job, rows, rays, slot);
    if (job.sumsLight()) blender_.record(commands, blended, job.layout->samples, sample);
  }
  if (!gathered) return;
  gatherer_.record(commands, *structures[0], gathered->texels, gathered->format, job, rows,
                   describeParams(job, 0, 0, slot),
                   {.met = slot.met_,
                    .lists = slot.met_lists_,
                    .sums = slot.sums_,
                    .band = slot.rgba(),
                    .wants_linear = blended.linear_address != 0});
}

}  // namespace viewloom
