// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "frame/cube_map.h"
#include "gpu/barrier.h"
#include "picture/ray_sources.h"
#include "shaders/join_faces.h"
#include "shaders/merge_sources.h"
#include "shared/cube_abi.h"
#include "shared/kernel_constants.h"
#include "trace/band_params.h"
#include "trace/face_rays.h"
#include "trace/view_tracer.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kMergeSlots[] = {{abi::kBindingViews, DescriptorKind::kStorage},
                                          {abi::kBindingExtras, DescriptorKind::kUniform},
                                          {abi::kBindingBand, DescriptorKind::kStorage},
                                          {abi::kBindingAnswers, DescriptorKind::kStorage}};
constexpr DescriptorSlot kJoinSlots[] = {{abi::kBindingAnswers, DescriptorKind::kStorage}};

}  // namespace

const ComputePass& ViewTracer::mergePass(uint32_t wanted, uint32_t rays) {
  std::lock_guard lock(mutex_);
  std::unique_ptr<ComputePass>& made = merge_passes_[{wanted, rays}];
  if (!made) {
    const KernelConstant constants[] = {{abi::kIdWanted, wanted}, {abi::kIdRays, rays}};
    made = std::make_unique<ComputePass>(*device_,
                                         ComputePassOptions{.spirv = merge_sources_spirv,
                                                            .push_bytes = sizeof(abi::MergePush),
                                                            .constants = constants,
                                                            .descriptors = kMergeSlots,
                                                            .debug_name = "merge sources"});
  }
  return *made;
}

const ComputePass& ViewTracer::joinPass() {
  std::lock_guard lock(mutex_);
  if (!join_pass_) {
    join_pass_ = std::make_unique<ComputePass>(
        *device_, ComputePassOptions{.spirv = join_faces_spirv,
                                     .push_bytes = sizeof(abi::JoinPush),
                                     .descriptors = kJoinSlots,
                                     .debug_name = "join faces"});
  }
  return *join_pass_;
}

// The walks of a piece of the band that may see something, a bit each.
uint64_t ViewTracer::recordWalks(Commands commands,
                                 std::span<const StructureSlot* const> structures,
                                 const TraceJob& job, BandRows piece, const Rays& rays,
                                 const AnswersLayout& answers, const TraceSlot& slot) {
  uint64_t walked = 0;
  for (uint32_t walk = 0; walk < job.walk_count; ++walk) {
    const StructureSlot& structure = *structures[walk];
    if (structure.shape().is_cube_face &&
        !raysMayEnterFace(raysOf(job, walk, rays.sample), structure.shape().depth_px,
                          structure.stats().inv_z_max)) {
      continue;
    }
    const uint64_t size_bytes = answers.stride * sizeof(abi::RayAnswer);
    const Descriptor target{.binding = abi::kBindingBand,
                            .kind = DescriptorKind::kStorage,
                            .buffer = &slot.answers_,
                            .offset_bytes = walk * size_bytes,
                            .size_bytes = size_bytes};
    recordWalk(commands, {structure, job, walk, rays, slot, target}, piece);
    walked |= uint64_t{1} << walk;
  }
  recordComputeBarrier(commands);
  return walked;
}

// Of each cube map one answer, in the place of its first face's.
void ViewTracer::recordJoins(Commands commands, const TraceJob& job, uint64_t walked,
                             uint32_t answer_count, const AnswersLayout& answers,
                             const TraceSlot& slot) {
  for (const JobSource& source : job.sources) {
    if (!source.isCubeMap()) continue;
    const ComputePass& join = joinPass();
    const abi::JoinPush push{
        .answer_count = answer_count,
        .answers_stride = answers.stride,
        .first_walk = source.first_walk,
        .walked_faces = uint32_t(walked >> source.first_walk) & ((1U << kCubeFaceCount) - 1)};
    const Descriptor target = wholeBuffer(abi::kBindingAnswers, slot.answers_);
    join.recordDescriptors(commands, std::span(&target, 1));
    join.record(commands, push, groupCount(answer_count));
    recordComputeBarrier(commands);
  }
}

// Piece by piece of the band: what each walk answers, and the px that follow from all answers.
void ViewTracer::recordMerged(Commands commands, std::span<const StructureSlot* const> structures,
                              const TraceJob& job, BandRows rows, const Rays& rays,
                              TraceSlot& slot) {
  const AtlasLayout& layout = *job.layout;
  const AnswersLayout answers = answersLayout(layout.size_px.width, rows.row_count, job.walk_count);
  const ComputePass& merge = mergePass(rays.wanted, raySourceOf(layout));
  std::vector<Descriptor> descriptors = describeParams(job, 0, rays.sample, slot);
  descriptors.push_back(wholeBuffer(abi::kBindingBand, slot.sampleTarget(job)));
  descriptors.push_back(wholeBuffer(abi::kBindingAnswers, slot.answers_));
  for (uint32_t row = 0; row < rows.row_count; row += answers.row_count) {
    const BandRows piece{rows.first_row + row, std::min(answers.row_count, rows.row_count - row)};
    const uint64_t walked = recordWalks(commands, structures, job, piece, rays, answers, slot);
    recordJoins(commands, job, walked, layout.size_px.width * piece.row_count, answers, slot);
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
