// SPDX-License-Identifier: Apache-2.0
#include "trace/path_mirror_pass.h"

#include <algorithm>

#include "gpu/commands.h"
#include "picture/ray_sources.h"
#include "shaders/merge_paths.h"
#include "shaders/turn_paths.h"
#include "shaders/walk_paths.h"
#include "shared/kernel_constants.h"
#include "trace/band_params.h"
#include "trace/mirrored_structure.h"
#include "trace/reflection_settings.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kMergeSlots[] = {{abi::kBindingAnswers, DescriptorKind::kStorage},
                                          {abi::kBindingPaths, DescriptorKind::kStorage},
                                          {abi::kBindingReflected, DescriptorKind::kStorage}};

// A bit for each source that has this.
template <typename Has>
uint32_t sourceBits(const TraceJob& job, const Has& has) {
  uint32_t bits = 0;
  for (size_t i = 0; i < job.sources.size(); ++i) bits |= uint32_t{has(job.sources[i])} << i;
  return bits;
}

abi::MergePathsPush mergePush(std::span<const StructureSlot* const> structures, const TraceJob& job,
                              const AnswersLayout& answers, const Buffer& counters) {
  const ReflectionSpec& spec = *job.reflection;
  const auto mirrors = [&](const JobSource& source) {
    return structures[source.first_walk]->surface() != nullptr;
  };
  return {.counters = addressWords(counters.address()),
          .atlas_width_px = job.layout->size_px.width,
          .band_row = 0,
          .source_count = uint32_t(job.sources.size()),
          .answers_stride = answers.stride,
          .first_walks = packFirstWalks(job),
          .cube_maps = sourceBits(job, [](const JobSource& source) { return source.isCubeMap(); }),
          .mirrors = sourceBits(job, mirrors),
          .bounce = 0,
          .bounce_count = spec.bounce_count,
          .sample_index = 0,
          .sample_count = spec.sample_count,
          .environment = environmentOf(spec)};
}

}  // namespace

struct PathMirrorPass::Piece {
  const StructureSlot& structure;
  const ComputePass* turn = nullptr;  // where the structure mirrors
  const ComputePass& walk;
  abi::TracePush push;  // with the structure's own colour
  std::vector<Descriptor> turn_descriptors;
  std::vector<Descriptor> walk_descriptors;
};

ComputePass PathMirrorPass::makeTurnPass(const Device& device, const TurnVariant& variant) {
  const KernelConstant constants[] = {{abi::kIdReadsByAddress, variant.reads_by_address},
                                      {abi::kIdRays, variant.rays},
                                      {abi::kIdThroughLens, variant.through_lens}};
  return {device,
          {.spirv = turn_paths_spirv,
           .push_bytes = sizeof(abi::TracePush),
           .takes_parts = true,
           .constants = constants,
           .descriptors = mirrorSlots({{abi::kBindingPaths, DescriptorKind::kStorage}}),
           .debug_name = "turn paths"}};
}

ComputePass PathMirrorPass::makeWalkPass(const Device& device, const WalkVariant& variant) {
  const KernelConstant constants[] = {{abi::kIdReadsByAddress, variant.reads_by_address},
                                      {abi::kIdColorFormat, variant.color_format},
                                      {abi::kIdColorIsScaled, variant.color_is_scaled},
                                      {abi::kIdIsCubeFace, variant.is_cube_face}};
  return {device,
          {.spirv = walk_paths_spirv,
           .push_bytes = sizeof(abi::TracePush),
           .takes_parts = true,
           .constants = constants,
           .descriptors = mirrorSlots({{abi::kBindingPaths, DescriptorKind::kStorage},
                                       {abi::kBindingBand, DescriptorKind::kStorage}}),
           .debug_name = "walk paths"}};
}

ComputePass PathMirrorPass::makeMergePass(const Device& device, const std::monostate&) {
  return {device,
          {.spirv = merge_paths_spirv,
           .push_bytes = sizeof(abi::MergePathsPush),
           .takes_parts = true,
           .descriptors = kMergeSlots,
           .debug_name = "merge paths"}};
}

PathMirrorPass::TurnVariant PathMirrorPass::turnVariantOf(const StructureSlot& structure,
                                                          const TraceJob& job) {
  return {.reads_by_address = structure.readsByAddress(),
          .rays = raySourceOf(*job.layout),
          .through_lens = job.hasLens()};
}

PathMirrorPass::WalkVariant PathMirrorPass::walkVariantOf(const StructureSlot& structure) {
  return {.reads_by_address = structure.readsByAddress(),
          .color_format = colorFormat(structure.shape().color_storage),
          .color_is_scaled = structure.shape().colorIsScaled(),
          .is_cube_face = structure.shape().is_cube_face};
}

void PathMirrorPass::addMissing(std::span<const StructureSlot* const> structures,
                                const TraceJob& job, MissingKernels& missing) {
  for (const StructureSlot* structure : structures) {
    if (structure->surface() != nullptr) {
      turn_passes_.addMissing(turnVariantOf(*structure, job), missing);
    }
    walk_passes_.addMissing(walkVariantOf(*structure), missing);
  }
  join_.addMissing(job, missing);
  merge_pass_.addMissing({}, missing);
}

std::vector<PathMirrorPass::Piece> PathMirrorPass::describe(
    std::span<const StructureSlot* const> structures, const Rows& rows, const BandRays& rays,
    uint32_t band_row) {
  std::vector<Piece> pieces;
  for (uint32_t index = 0; index < rows.job.walk_count; ++index) {
    const StructureSlot& structure = *structures[index];
    const bool mirrors = structure.surface() != nullptr;
    const Walk walk{structure, rows.job, index, rays};
    Piece piece{.structure = structure,
                .turn = mirrors ? &turn_passes_.get(turnVariantOf(structure, rows.job)) : nullptr,
                .walk = walk_passes_.get(walkVariantOf(structure)),
                .push = tracePush(walk, structure.color(), rows.piece),
                .turn_descriptors =
                    mirrorDescriptors(structure, mirrorParams(walk, 0, rows.slot), albedos_),
                .walk_descriptors = {}};
    piece.push.band_row = band_row;
    piece.turn_descriptors.push_back(wholeBuffer(abi::kBindingPaths, rows.slot.paths()));
    piece.walk_descriptors = piece.turn_descriptors;
    piece.walk_descriptors.push_back(rows.slot.answersOf(index, rows.answers));
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

// All rays of one sample that have met as many mirrors: turned where they are, then followed
// through every source.
void PathMirrorPass::recordBounce(Commands commands, std::span<Piece> pieces, const Rows& rows,
                                  const abi::MergePathsPush& push) {
  bool is_first = true;
  for (Piece& piece : pieces) {
    piece.push.bounce = push.bounce;
    piece.push.sample_index = push.sample_index;
    if (piece.turn == nullptr) continue;
    uint32_t& fill = piece.push.fill;
    fill = is_first ? fill | abi::kFillFirst : fill & ~abi::kFillFirst;
    piece.turn->recordDescriptors(commands, piece.turn_descriptors);
    piece.turn->recordColumns(commands, piece.push, rows.columns, rows.piece.row_count);
    recordComputeBarrier(commands);
    is_first = false;
  }
  for (const Piece& piece : pieces) {
    piece.walk.recordDescriptors(commands, piece.walk_descriptors);
    piece.walk.recordColumns(commands, piece.push, rows.columns, rows.piece.row_count);
  }
  recordComputeBarrier(commands);
  const uint64_t all = (uint64_t{1} << rows.job.walk_count) - 1;
  join_.record(commands, rows.job, all, rows.answered, rows.answers, rows.slot);
  const Descriptor descriptors[] = {wholeBuffer(abi::kBindingAnswers, rows.slot.answers()),
                                    wholeBuffer(abi::kBindingPaths, rows.slot.paths()),
                                    wholeBuffer(abi::kBindingReflected, rows.slot.reflected())};
  const ComputePass& merge = merge_pass_.get({});
  merge.recordDescriptors(commands, descriptors);
  merge.recordColumns(commands, push, rows.columns, rows.piece.row_count);
  recordComputeBarrier(commands);
}

// Piece by piece of the rows, as the views' own rays are traced.
void PathMirrorPass::record(Commands commands, std::span<const StructureSlot* const> structures,
                            const TraceJob& job, BandRows rows, const BandPart& part,
                            const TraceSlot& slot) {
  const AnswersLayout answers =
      reflectedAnswersLayout(job.layout->size_px.width, rows.row_count, job.walk_count);
  abi::MergePathsPush push = mergePush(structures, job, answers, slot.counters());
  for (uint32_t row = part.first_row; row < part.end_row; row += answers.row_count) {
    const BandRows piece{rows.first_row + row, std::min(answers.row_count, part.end_row - row)};
    const uint32_t end_answer = (piece.row_count - 1) * job.layout->size_px.width + part.end_column;
    const Rows piece_rows{job,     piece, groupsOf(part), {part.first_column, end_answer},
                          answers, slot};
    push.band_row = row;
    std::vector<Piece> pieces =
        describe(structures, piece_rows, {.sample = part.first_sample}, row);
    // The rays stay in memory as they are from one part to the next.
    for (uint32_t step = part.first_step; step < part.end_step; ++step) {
      push.sample_index = step / push.bounce_count;
      push.bounce = step % push.bounce_count;
      recordBounce(commands, pieces, piece_rows, push);
    }
  }
}

}  // namespace viewloom
