// SPDX-License-Identifier: Apache-2.0
#include "trace/merge_pass.h"

#include <algorithm>
#include <array>

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
           .constants = constants,
           .descriptors = kMergeSlots,
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
                       const TraceJob& job, BandRows rows, RowSpan span, const BandRays& rays,
                       const TraceSlot& slot) {
  const AtlasLayout& layout = *job.layout;
  const AnswersLayout answers = answersLayout(layout.size_px.width, rows.row_count, job.walk_count);
  const uint64_t walks = walksOf(structures, job, rays);
  const ComputePass& merge = passes_.get(variantOf(job, rays));
  std::vector<Descriptor> descriptors = slot.params().of(job, 0, rays.sample);
  descriptors.push_back(wholeBuffer(abi::kBindingBand, slot.sampleTarget(job)));
  descriptors.push_back(wholeBuffer(abi::kBindingAnswers, slot.answers()));
  for (uint32_t row = span.first; row < span.end; row += answers.row_count) {
    const BandRows piece{rows.first_row + row, std::min(answers.row_count, span.end - row)};
    for (uint32_t walk = 0; walk < job.walk_count; ++walk) {
      if (!hasBit(walks, walk)) continue;
      walk_.record(commands, {*structures[walk], job, walk, rays}, piece, {0, piece.row_count},
                   slot, slot.answersOf(walk, answers));
    }
    recordComputeBarrier(commands);
    join_.record(commands, job, walks, {.end = layout.size_px.width * piece.row_count}, answers,
                 slot);
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
