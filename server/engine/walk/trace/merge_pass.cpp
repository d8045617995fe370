// SPDX-License-Identifier: Apache-2.0
#include "trace/merge_pass.h"

#include <algorithm>

#include "gpu/commands.h"
#include "picture/ray_sources.h"
#include "shaders/merge_sources.h"
#include "shared/kernel_constants.h"
#include "trace/band_params.h"
#include "trace/face_rays.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kSlots[] = {{abi::kBindingViews, DescriptorKind::kStorage},
                                     {abi::kBindingExtras, DescriptorKind::kUniform},
                                     {abi::kBindingBand, DescriptorKind::kStorage},
                                     {abi::kBindingAnswers, DescriptorKind::kStorage}};

bool hasBit(uint64_t bits, uint32_t index) {
  return (bits >> index & 1) != 0;
}

}  // namespace

ComputePass MergePass::makePass(const Device& device, const Variant& variant) {
  const KernelConstant constants[] = {{abi::kIdWanted, variant.wanted},
                                      {abi::kIdRays, variant.rays}};
  return {device,
          {.spirv = merge_sources_spirv,
           .push_bytes = sizeof(abi::MergePush),
           .constants = constants,
           .descriptors = kSlots,
           .debug_name = "merge sources"}};
}

MergePass::Variant MergePass::variantOf(const TraceJob& job, const BandRays& rays) {
  return {.wanted = rays.wanted, .rays = raySourceOf(*job.layout)};
}

uint64_t MergePass::walksOf(std::span<const StructureSlot* const> structures, const TraceJob& job,
                            const BandRays& rays) {
  uint64_t walks = 0;
  for (uint32_t walk = 0; walk < job.walk_count; ++walk) {
    const StructureSlot& structure = *structures[walk];
    const bool may_see = !structure.shape().is_cube_face ||
                         raysMayEnterFace(raysOf(job, walk, rays.sample),
                                          structure.shape().depth_px, structure.stats().inv_z_max);
    walks |= uint64_t{may_see} << walk;
  }
  return walks;
}

void MergePass::addMissing(std::span<const StructureSlot* const> structures, const TraceJob& job,
                           const BandRays& rays, MissingKernels& missing) {
  const uint64_t walks = walksOf(structures, job, rays);
  for (uint32_t walk = 0; walk < job.walk_count; ++walk) {
    if (hasBit(walks, walk)) walk_.addMissing({*structures[walk], job, walk, rays}, missing);
  }
  join_.addMissing(job, missing);
  passes_.addMissing(variantOf(job, rays), missing);
}

// Piece by piece of the band.
void MergePass::record(Commands commands, std::span<const StructureSlot* const> structures,
                       const TraceJob& job, BandRows rows, const BandRays& rays,
                       const TraceSlot& slot) {
  const AtlasLayout& layout = *job.layout;
  const AnswersLayout answers = answersLayout(layout.size_px.width, rows.row_count, job.walk_count);
  const uint64_t walks = walksOf(structures, job, rays);
  const ComputePass& merge = passes_.get(variantOf(job, rays));
  std::vector<Descriptor> descriptors = slot.params().of(job, 0, rays.sample);
  descriptors.push_back(wholeBuffer(abi::kBindingBand, slot.sampleTarget(job)));
  descriptors.push_back(wholeBuffer(abi::kBindingAnswers, slot.answers()));
  for (uint32_t row = 0; row < rows.row_count; row += answers.row_count) {
    const BandRows piece{rows.first_row + row, std::min(answers.row_count, rows.row_count - row)};
    for (uint32_t walk = 0; walk < job.walk_count; ++walk) {
      if (!hasBit(walks, walk)) continue;
      walk_.record(commands, {*structures[walk], job, walk, rays}, piece, slot,
                   slot.answersOf(walk, answers));
    }
    recordComputeBarrier(commands);
    join_.record(commands, job, walks, layout.size_px.width * piece.row_count, answers, slot);
    const abi::MergePush push{.atlas_width_px = layout.size_px.width,
                              .first_row = piece.first_row,
                              .band_row = row,
                              .tile_size_px = packSize(layout.tile_size_px),
                              .tile_grid = packSize({layout.columns, layout.rows}),
                              .padding_top_px = layout.padding_top_px,
                              .fill = redFirst(job.background_rgb),
                              .source_count = uint32_t(job.sources.size()),
                              .answers_stride = answers.stride,
                              .first_walks = packFirstWalks(job)};
    merge.recordDescriptors(commands, descriptors);
    merge.record(commands, push, groupCount(layout.tile_size_px.width * layout.columns),
                 piece.row_count);
    recordComputeBarrier(commands);
  }
}

}  // namespace viewloom
