// SPDX-License-Identifier: Apache-2.0
#include "trace/merge_pass.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "gpu/commands.h"
#include "picture/ray_sources.h"
#include "shaders/merge_sources.h"
#include "shared/cube_abi.h"
#include "shared/kernel_constants.h"
#include "trace/band_params.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kMergeSlots[] = {{abi::kBindingViews, DescriptorKind::kStorage},
                                          {abi::kBindingExtras, DescriptorKind::kUniform},
                                          {abi::kBindingBand, DescriptorKind::kStorage},
                                          {abi::kBindingAnswers, DescriptorKind::kStorage}};

bool hasBit(uint64_t bits, uint32_t index) {
  return (bits >> index & 1) != 0;
}

// How far a homogeneous point is inside of what bounds a face: its sides, and the nearest surface.
// `unit`: of the point, 0 for a direction.
std::array<float, 5> insideOf(const abi::vec3& point, float unit, SizePx size_px,
                              float inv_z_near) {
  const float own_px = float(abi::kCubeApron_px) - abi::kSeamOverlap_px;
  const float side_px = float(size_px.width) - own_px;
  return {point.x - own_px * point.z, point.y - own_px * point.z, side_px * point.z - point.x,
          side_px * point.z - point.y, inv_z_near * point.z - unit};
}

// Each bound is linear along a ray, and its directions are over a tile: corners decide.
bool mayEnter(const abi::ViewParams& tile, SizePx tile_px, SizePx size_px, float inv_z_near) {
  std::array<float, 5> most = insideOf(tile.eye, 1, size_px, inv_z_near);
  for (const float x_px : {0.0F, float(tile_px.width)}) {
    for (const float y_px : {0.0F, float(tile_px.height)}) {
      const abi::vec3 direction =
          tile.direction + x_px * tile.direction_dx + y_px * tile.direction_dy;
      const std::array<float, 5> inside = insideOf(direction, 0, size_px, inv_z_near);
      for (size_t i = 0; i < most.size(); ++i) most[i] = std::max(most[i], inside[i]);
    }
  }
  return std::none_of(most.begin(), most.end(), [](float inside) { return inside < 0; });
}

// Whether some of these rays may enter a face of a cube map whose largest inv_z is this, 1/m; false
// only where none does. `size_px`: of the face with its apron.
bool raysMayEnterFace(const TileRays& rays, SizePx size_px, double inv_z_max) {
  const float inv_z_near = std::max(float(inv_z_max), abi::kInvZNearMin) * abi::kInvZNearMargin;
  // Rays from eyes between two that do not enter may do so.
  if (rays.are_bounds) return true;
  return std::any_of(rays.tiles.begin(), rays.tiles.end(), [&](const abi::ViewParams& tile) {
    return tile.is_used != 0 && mayEnter(tile, rays.tile_px, size_px, inv_z_near);
  });
}

}  // namespace

ComputePass MergePass::makePass(const Device& device, const Variant& variant) {
  const KernelConstant constants[] = {{abi::kIdWanted, variant.wanted},
                                      {abi::kIdRays, variant.rays}};
  return {device,
          {.spirv = merge_sources_spirv,
           .push_bytes = sizeof(abi::MergePush),
           .takes_parts = true,
           .constants = constants,
           .descriptors = kMergeSlots,
           .debug_name = "merge sources"}};
}

MergePass::Variant MergePass::variantOf(const TraceJob& job, const BandRays& rays) {
  return {.wanted = rays.wanted, .rays = raySourceOf(*job.layout)};
}

uint64_t MergePass::walksOf(std::span<const StructureSlot* const> structures, const TraceJob& job,
                            const BandRays& rays, Walks of) {
  uint64_t walks = 0;
  for (uint32_t walk = of.first; walk < of.end; ++walk) {
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
  const uint64_t walks = walksOf(structures, job, rays, {0, job.walk_count});
  for (uint32_t walk = 0; walk < job.walk_count; ++walk) {
    if (hasBit(walks, walk)) walk_.addMissing({*structures[walk], job, walk, rays}, missing);
  }
  join_.addMissing(job, missing);
  passes_.addMissing(variantOf(job, rays), missing);
}

struct MergePass::Piece {
  std::span<const StructureSlot* const> structures;
  const TraceJob& job;
  const TraceSlot& slot;
  AnswersLayout answers;
  uint64_t walks;     // of walksOf()
  BandRows rows;      // of the atlas
  uint32_t band_row;  // of the first
};

uint64_t MergePass::rayCount(std::span<const StructureSlot* const> structures, const TraceJob& job,
                             const BandPart& part) {
  const uint64_t px_count =
      uint64_t{part.end_row - part.first_row} * (part.end_column - part.first_column);
  uint64_t ray_count = 0;
  for (uint32_t sample = part.first_sample; sample < part.end_sample; ++sample) {
    const uint64_t walks =
        walksOf(structures, job, {.sample = sample}, {part.first_walk, part.end_walk});
    ray_count += px_count * uint64_t(std::popcount(walks));
  }
  return ray_count;
}

void MergePass::recordWalks(Commands commands, const Piece& piece, const BandPart& part,
                            const BandRays& rays) {
  for (uint32_t walk = part.first_walk; walk < part.end_walk; ++walk) {
    if (!hasBit(piece.walks, walk)) continue;
    walk_.record(
        commands, {*piece.structures[walk], piece.job, walk, rays}, piece.rows,
        {.rows = {0, piece.rows.row_count}, .columns = {part.first_column, part.end_column}},
        piece.slot, piece.slot.answersOf(walk, piece.answers));
  }
  recordComputeBarrier(commands);
}

void MergePass::recordMerge(Commands commands, const Piece& piece, const BandPart& part,
                            const BandRays& rays) {
  const TraceJob& job = piece.job;
  const AtlasLayout& layout = *job.layout;
  const uint32_t end_answer = (piece.rows.row_count - 1) * layout.size_px.width + part.end_column;
  join_.record(commands, job, piece.walks, {part.first_column, end_answer}, piece.answers,
               piece.slot);
  // Beside the views is nothing.
  GroupColumns columns = groupsOf(part);
  columns.end = std::min(columns.end, groupCount(layout.tile_size_px.width * layout.columns));
  if (columns.first >= columns.end) return;
  const abi::MergePush push{.atlas_width_px = layout.size_px.width,
                            .first_row = piece.rows.first_row,
                            .band_row = piece.band_row,
                            .tile_size_px = packSize(layout.tile_size_px),
                            .tile_grid = packSize({layout.columns, layout.rows}),
                            .padding_top_px = layout.padding_top_px,
                            .fill = redFirst(job.background_rgb),
                            .source_count = uint32_t(job.sources.size()),
                            .answers_stride = piece.answers.stride,
                            .first_walks = packFirstWalks(job)};
  std::vector<Descriptor> descriptors = piece.slot.params().of(job, 0, rays.sample);
  descriptors.push_back(wholeBuffer(abi::kBindingBand, piece.slot.sampleTarget(job)));
  descriptors.push_back(wholeBuffer(abi::kBindingAnswers, piece.slot.answers()));
  const ComputePass& merge = passes_.get(variantOf(job, rays));
  merge.recordDescriptors(commands, descriptors);
  merge.recordColumns(commands, push, columns, piece.rows.row_count);
  recordComputeBarrier(commands);
}

// Piece by piece of the band.
void MergePass::record(Commands commands, std::span<const StructureSlot* const> structures,
                       const TraceJob& job, BandRows rows, const BandPart& part,
                       const BandRays& rays, const TraceSlot& slot) {
  Piece piece{.structures = structures,
              .job = job,
              .slot = slot,
              .answers = answersLayout(job.layout->size_px.width, rows.row_count, job.walk_count),
              .walks = walksOf(structures, job, rays, {part.first_walk, part.end_walk}),
              .rows = {},
              .band_row = 0};
  for (uint32_t row = part.first_row; row < part.end_row; row += piece.answers.row_count) {
    piece.rows = {rows.first_row + row, std::min(piece.answers.row_count, part.end_row - row)};
    piece.band_row = row;
    if (part.walks()) recordWalks(commands, piece, part, rays);
    if (part.merges) recordMerge(commands, piece, part, rays);
  }
}

}  // namespace viewloom
