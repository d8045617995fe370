// SPDX-License-Identifier: Apache-2.0
// The rays of each px: one, or several whose light is averaged.
#include "gpu/barrier.h"
#include "shared/lens_abi.h"
#include "trace/band_params.h"
#include "trace/view_tracer.h"

namespace viewloom {
namespace {

// Such a ray has no single surface to compare with.
bool seesThrough(const StructureSlot& structure) {
  return colorFormat(structure.shape().color_storage) == abi::kColorRgba16f;
}

}  // namespace

void ViewTracer::recordRays(Commands commands, std::span<const StructureSlot* const> structures,
                            const TraceJob& job, BandRows rows, const Rays& rays, TraceSlot& slot) {
  if (job.walk_count == 1) {
    const Descriptor band = wholeBuffer(abi::kBindingBand, slot.sampleTarget(job));
    recordWalk(commands, {*structures[0], job, 0, rays, slot, band}, rows);
  } else {
    recordMerged(commands, structures, job, rows, rays, slot);
  }
}

void ViewTracer::recordSamples(Commands commands, std::span<const StructureSlot* const> structures,
                               const TraceJob& job, BandRows rows, const BandPart& part,
                               TraceSlot& slot) {
  // What else is wanted than colour is that of the ray through the middle of px and lens.
  const uint32_t wanted = wantedFlags(slot.shape_.outputs);
  if (job.gathers_on_host) {
    recordMiddleRays(commands, structures, job, rows, wanted, slot);
    return;
  }
  const bool has_middle_apart = job.hasLens() && (wanted & ~abi::kWantLinear) != 0;
  if (has_middle_apart && part.walks() && part.first_sample == 0) {
    recordRays(commands, structures, job, rows, {.wanted = wanted & ~abi::kWantLinear}, slot);
    recordComputeBarrier(commands);
  }
  if (job.mayGather() && !seesThrough(*structures[0])) {
    recordLensSamples(commands, *structures[0], job, rows, part, slot);
    return;
  }
  const BlendTarget blended{
      .sample = slot.sampleTarget(job),
      .sums = slot.sums_,
      .band = slot.rgba(),
      .linear_address = slot.linear_.isEmpty() ? 0 : slot.linear_.target().address(),
      .px_count = uint32_t(slot.band_px_.area())};
  if (part.reflects) {
    recordReflections(commands, structures, job, rows, part, slot);
    if (part.end_row == rows.row_count && job.sumsLight()) {
      blender_.record(commands, blended, job.layout->samples, part.first_sample);
    }
  }
  for (uint32_t sample = part.first_sample; sample < part.end_sample; ++sample) {
    const Rays rays{.sample = sample,
                    .through_lens = job.hasLens(),
                    .wanted = (sample == 0 && !has_middle_apart ? wanted : 0) |
                              (job.reflects() ? abi::kWantRecords : 0)};
    recordRays(commands, structures, job, rows, rays, slot);
    if (job.sumsLight() && !job.reflects())
      blender_.record(commands, blended, job.layout->samples, sample);
  }
}

// Of a lens that the host gathers. What a middle ray is taken to see that ends behind something
// would be as sharp as without a lens: there the rays of the first stage are walked.
void ViewTracer::recordMiddleRays(Commands commands,
                                  std::span<const StructureSlot* const> structures,
                                  const TraceJob& job, BandRows rows, uint32_t wanted,
                                  TraceSlot& slot) {
  recordEmptyList(commands, slot.incomplete_);
  recordRays(commands, structures, job, rows, {.wanted = wanted, .lists_hidden = true}, slot);
  recordComputeBarrier(commands);
  const uint32_t count = job.layout->lens->walked_count;
  recordRays(commands, structures, job, rows,
             {.wanted = wanted & abi::kWantLinear, .count_of_hidden = count}, slot);
}

// Rays that are walked add their light, and leave what they met: blocks where a round of them met
// nothing new have no more of them. The second stage makes px of the sums.
void ViewTracer::recordLensSamples(Commands commands, const StructureSlot& structure,
                                   const TraceJob& job, BandRows rows, const BandPart& part,
                                   TraceSlot& slot) {
  std::vector<Descriptor> params = describeParams(job, 0, 0, slot);
  const MetTarget met{slot.met_, slot.met_lists_, slot.incomplete_};
  for (uint32_t sample = part.first_sample; sample < part.end_sample; ++sample) {
    const MetRound round = metRound(sample, job.sample_count);
    const Rays rays{.sample = sample,
                    .through_lens = true,
                    .wanted = abi::kWantMet | abi::kWantSum,
                    .is_of_blocks = round.first > 0};
    const Descriptor band = wholeBuffer(abi::kBindingBand, slot.sampleTarget(job));
    recordWalk(commands, {structure, job, 0, rays, slot, band}, rows);
    recordComputeBarrier(commands);
    if (sample + 1 == round.end) {
      gatherer_.recordLists(commands, structure, job, rows, params.front(), met, round);
    }
  }
  if (part.walks()) return;
  const TileRays rays = raysOf(job, 0, 0);
  const ColorAverager::Color color =
      averager_.record(commands, structure, colorReach(rays.tiles, rays.tile_px));
  params.push_back(slot.lensDescriptor(job, 0));
  gatherer_.record(commands, structure, color.texels, color.format, job,
                   {rows, part.first_row, part.end_row}, params,
                   {.lists = slot.met_lists_,
                    .sums = slot.sums_,
                    .band = slot.rgba(),
                    .wants_linear = !slot.linear_.isEmpty()});
}

}  // namespace viewloom
