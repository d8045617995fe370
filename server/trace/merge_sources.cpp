// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "gpu/barrier.h"
#include "shaders/merge_sources.h"
#include "trace/band_params.h"
#include "trace/view_tracer.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kMergeSlots[] = {{abi::kBindingViews, DescriptorKind::kStorage},
                                          {abi::kBindingExtras, DescriptorKind::kUniform},
                                          {abi::kBindingBand, DescriptorKind::kStorage},
                                          {abi::kBindingAnswers, DescriptorKind::kStorage}};

}  // namespace

const ComputePass& ViewTracer::mergePass(uint32_t wanted) {
  std::lock_guard lock(mutex_);
  std::unique_ptr<ComputePass>& made = merge_passes_[wanted];
  if (!made) {
    const uint32_t constants[] = {0, 0, wanted};
    made = std::make_unique<ComputePass>(*device_,
                                         ComputePassOptions{.spirv = merge_sources_spirv,
                                                            .push_bytes = sizeof(abi::MergePush),
                                                            .specialization = constants,
                                                            .descriptors = kMergeSlots,
                                                            .debug_name = "merge sources"});
  }
  return *made;
}

// Piece by piece of the band: what each source answers, and the px that follow from all answers.
void ViewTracer::recordMerged(vk::CommandBuffer commands,
                              std::span<const StructureSlot* const> structures, const TraceJob& job,
                              BandRows rows, TraceSlot& slot) {
  const AtlasLayout& layout = *job.layout;
  const AnswersLayout answers =
      answersLayout(layout.size_px.width, rows.row_count, job.source_count);
  const ComputePass& merge = mergePass(wantedFlags(slot.shape_.outputs));
  std::vector<Descriptor> descriptors = describeParams(job, 0, slot);
  descriptors.push_back(wholeBuffer(abi::kBindingBand, slot.rgba()));
  descriptors.push_back(wholeBuffer(abi::kBindingAnswers, slot.answers_));
  for (uint32_t row = 0; row < rows.row_count; row += answers.row_count) {
    const BandRows piece{rows.first_row + row, std::min(answers.row_count, rows.row_count - row)};
    for (uint32_t source = 0; source < job.source_count; ++source) {
      const uint64_t size_bytes = answers.stride * sizeof(abi::RayAnswer);
      const Descriptor target{.binding = abi::kBindingBand,
                              .kind = DescriptorKind::kStorage,
                              .buffer = slot.answers_.handle(),
                              .offset_bytes = source * size_bytes,
                              .size_bytes = size_bytes};
      recordWalk(commands, {*structures[source], job, source, slot, target}, piece);
    }
    recordComputeBarrier(commands);
    const abi::MergePush push{.atlas_width_px = layout.size_px.width,
                              .first_row = piece.first_row,
                              .band_row = row,
                              .tile_size_px = packSize(layout.tile_size_px),
                              .tile_grid = packSize({layout.columns, layout.rows}),
                              .padding_top_px = layout.padding_top_px,
                              .fill = redFirst(job.background_rgb),
                              .source_count = job.source_count,
                              .answers_stride = answers.stride};
    merge.recordDescriptors(commands, descriptors);
    merge.record(commands, push, groupCount(layout.tile_size_px.width * layout.columns),
                 piece.row_count);
    recordComputeBarrier(commands);
  }
}

}  // namespace viewloom
