// SPDX-License-Identifier: Apache-2.0
#include "trace/walk_pass.h"

#include <algorithm>
#include <cstddef>

#include "gpu/commands.h"
#include "picture/ray_sources.h"
#include "shaders/walk_views.h"
#include "shared/kernel_constants.h"
#include "shared/lens_abi.h"
#include "trace/band_params.h"
#include "trace/met_blocks.h"
#include "trace/px_runs.h"

namespace viewloom {
namespace {

// Each of several sources says from where on it has seen rays. What others see is compared with
// that, and may be nearer than anything the source holds itself, as where that is nothing but sky.
// With this, eyes count as in the plane up to 2^-30 m from it: there they are one with it
// (abi::kAtEye).
constexpr double kInvZOfOthers = 1;  // 1/m

constexpr DescriptorSlot kWalkSlots[] = {{abi::kBindingStructure, DescriptorKind::kTexels},
                                         {abi::kBindingStructureHalves, DescriptorKind::kTexels},
                                         {abi::kBindingColor, DescriptorKind::kTexels},
                                         {abi::kBindingMeasured, DescriptorKind::kUniform},
                                         {abi::kBindingViews, DescriptorKind::kStorage},
                                         {abi::kBindingExtras, DescriptorKind::kUniform},
                                         {abi::kBindingLensPoints, DescriptorKind::kStorage},
                                         {abi::kBindingBand, DescriptorKind::kStorage},
                                         {abi::kBindingSums, DescriptorKind::kStorage},
                                         {abi::kBindingIncomplete, DescriptorKind::kStorage},
                                         {abi::kBindingUnfinished, DescriptorKind::kStorage}};

uint32_t shownBeside(const TraceJob& job) {
  uint32_t flags = 0;
  for (const abi::ViewParams& tile : job.tilesOf(0)) flags |= tile.shows;
  return flags;
}

ColorReach reachOf(const Walk& walk) {
  const TileRays rays = raysOf(walk.job, walk.index, walk.rays.sample);
  return colorReach(rays.tiles, rays.tile_px);
}

constexpr uint64_t kGroupsOffset = offsetof(abi::IncompleteHead, group_count);

// Groups for these px of a row of so many runs, whichever views neighbouring runs are of.
GroupColumns groupsOf(ColumnSpan columns, uint32_t width_px, uint32_t run_count) {
  const auto groupAt = [&](uint64_t column) {
    return column == width_px ? groupCount(run_count)
                              : uint32_t(column * run_count / width_px / abi::kTraceGroupSize);
  };
  return {groupAt(columns.first), groupAt(columns.end)};
}

// Every binding of a kernel has to have a buffer, also one that its variant does not use: there
// stands what it writes anyhow, so that walks beside each other need not wait.
Descriptor usedOr(uint32_t binding, bool is_used, const Buffer& buffer, Descriptor target) {
  target.binding = binding;
  return is_used ? wholeBuffer(binding, buffer) : target;
}

}  // namespace

ComputePass WalkPass::makePass(const Device& device, const Variant& variant) {
  const KernelConstant constants[] = {{abi::kIdReadsByAddress, variant.reads_by_address},
                                      {abi::kIdWanted, variant.wanted},
                                      {abi::kIdColorFormat, variant.color_format},
                                      {abi::kIdPixelsPerInvocation, variant.pixels_per_invocation},
                                      {abi::kIdLanesAreViews, variant.lanes_are_views},
                                      {abi::kIdColorIsScaled, variant.color_is_scaled},
                                      {abi::kIdRaysArePlain, variant.rays_are_plain},
                                      {abi::kIdEyesInPlane, variant.eyes_in_plane},
                                      {abi::kIdIsOneOfSeveral, variant.is_one_of_several},
                                      {abi::kIdIsCubeFace, variant.is_cube_face},
                                      {abi::kIdRays, variant.rays},
                                      {abi::kIdShownBeside, variant.shown_beside},
                                      {abi::kIdThroughLens, variant.through_lens},
                                      {abi::kIdIsOfBlocks, variant.is_of_blocks},
                                      {abi::kIdListsHidden, variant.lists_hidden},
                                      {abi::kIdRaysOfHidden, variant.rays_of_hidden},
                                      {abi::kIdListsUnfinished, variant.lists_unfinished}};
  return {device,
          {.spirv = walk_views_spirv,
           .push_bytes = sizeof(abi::TracePush),
           .takes_parts = true,
           .constants = constants,
           .descriptors = kWalkSlots,
           .debug_name = "walk views"}};
}

WalkPass::Variant WalkPass::variantOf(const Walk& walk) const {
  const AtlasLayout& layout = *walk.job.layout;
  const StructureSlot& structure = walk.structure;
  const TileRays rays = raysOf(walk.job, walk.index, walk.rays.sample);
  const double inv_z_max = structure.stats().inv_z_max;
  const bool is_one_of_several = walk.job.walk_count > 1;
  const bool eyes_in_plane = eyesAreInPlane(
      rays.tiles, is_one_of_several ? std::max(inv_z_max, kInvZOfOthers) : inv_z_max);
  // Merged rays are plain too, if they are linear in their eye and all at one depth.
  const bool rays_are_plain =
      (eyes_in_plane || !rays.are_bounds) && raysArePlain(rays.tiles, rays.tile_px, inv_z_max);
  return {.reads_by_address = structure.readsByAddress(),
          .wanted = is_one_of_several ? 0 : walk.rays.wanted,
          .color_format = MeanColorPass::formatOf(structure, reachOf(walk)),
          .pixels_per_invocation = pixelsOfRun(device_.info(), structure, layout),
          .lanes_are_views = lanesAreViews(layout),
          .color_is_scaled = structure.shape().colorIsScaled(),
          .rays_are_plain = rays_are_plain,
          .eyes_in_plane = eyes_in_plane,
          .is_one_of_several = is_one_of_several,
          .is_cube_face = structure.shape().is_cube_face,
          .rays = raySourceOf(layout),
          .shown_beside = is_one_of_several ? 0 : shownBeside(walk.job),
          .through_lens = walk.rays.through_lens,
          .is_of_blocks = walk.rays.is_of_blocks,
          .lists_hidden = walk.rays.lists_hidden,
          .rays_of_hidden = walk.rays.count_of_hidden,
          .lists_unfinished = device_.info().is_software && !walk.rays.areListed()};
}

void WalkPass::addMissing(const Walk& walk, MissingKernels& missing) {
  mean_color_.addMissing(walk.structure, reachOf(walk), missing);
  passes_.addMissing(variantOf(walk), missing);
}

std::vector<Descriptor> WalkPass::describe(const Walk& walk, const Variant& variant,
                                           const LayeredBuffer& color, const TraceSlot& slot,
                                           const Descriptor& target) {
  const StructureSlot& structure = walk.structure;
  std::vector<Descriptor> descriptors = slot.params().of(walk.job, walk.index, walk.rays.sample);
  const bool sums = (walk.rays.wanted & abi::kWantSum) != 0;
  const bool lists = walk.rays.areListed() || walk.rays.lists_hidden;
  for (const Descriptor& descriptor :
       {structure.measuredDescriptor(), target,
        slot.params().lensPoints(walk.job, walk.rays.sample),
        structure.structure().asTexels(abi::kBindingStructure),
        structure.structure().asHalfTexels(abi::kBindingStructureHalves),
        color.asTexels(abi::kBindingColor), usedOr(abi::kBindingSums, sums, slot.sums(), target),
        usedOr(abi::kBindingIncomplete, lists, slot.incomplete(), target),
        usedOr(abi::kBindingUnfinished, variant.lists_unfinished, slot.unfinished(), target)}) {
    descriptors.push_back(descriptor);
  }
  return descriptors;
}

uint64_t WalkPass::recordMeans(Commands commands, const Walk& walk, uint64_t texel_count_max) {
  return mean_color_.recordRows(commands, walk.structure, reachOf(walk), texel_count_max);
}

// Dispatches as many groups as the list has. A share of it is taken as if all blocks were listed,
// as nobody but the device knows how many are: groups behind its end have nothing to do.
void WalkPass::recordListed(Commands commands, const ComputePass& pass, const abi::TracePush& push,
                            const Walk& walk, BandRows rows, const Px& px, const TraceSlot& slot) {
  const uint64_t width_px = walk.job.layout->size_px.width;
  const uint64_t first = px.rows.first * width_px + px.columns.first;
  const uint64_t end = (px.rows.end - 1) * width_px + px.columns.end;
  const uint64_t area_px = rows.row_count * width_px;
  if (!walk.rays.is_of_blocks || end - first == area_px) {
    pass.recordIndirect(commands, push, slot.incomplete(), kGroupsOffset);
    return;
  }
  const MetBlocks blocks = metBlocks(*walk.job.layout, rows);
  const uint64_t group_count =
      groupCount(blocks.per_row * blocks.row_count * abi::kMetBlockSide_px);
  const auto groupAt = [&](uint64_t px_index) {
    return uint32_t(px_index * group_count / area_px);
  };
  const GroupColumns groups{groupAt(first), groupAt(end)};
  if (groups.first < groups.end) pass.recordColumns(commands, push, groups, 1);
}

void WalkPass::record(Commands commands, const Walk& walk, BandRows rows, const Px& px,
                      const TraceSlot& slot, const Descriptor& target) {
  const Variant variant = variantOf(walk);
  const ComputePass& walk_views = passes_.get(variant);
  const MeanColorPass::Color color = mean_color_.record(commands, walk.structure, reachOf(walk));
  if (variant.lists_unfinished) recordEmptyList(commands, slot.unfinished());
  walk_views.recordDescriptors(commands, describe(walk, variant, color.texels, slot, target));
  abi::TracePush push = tracePush(walk, color.texels, rows);
  push.band_row = px.rows.first;
  if (walk.rays.areListed()) {
    recordListed(commands, walk_views, push, walk, rows, px, slot);
    return;
  }
  const AtlasLayout& layout = *walk.job.layout;
  const uint32_t pixels = variant.pixels_per_invocation;
  const uint32_t runs = (layout.tile_size_px.width + pixels - 1) / pixels * layout.columns;
  const GroupColumns groups = groupsOf(px.columns, layout.size_px.width, runs);
  if (groups.first == groups.end) return;
  walk_views.recordColumns(commands, push, groups, px.rows.end - px.rows.first);
  if (!variant.lists_unfinished) return;
  recordComputeBarrier(commands);
  push.fill |= abi::kFillUnfinished;
  push.band_row = 0;  // they are listed with their rows of the band
  walk_views.recordIndirect(commands, push, slot.unfinished(), kGroupsOffset);
}

}  // namespace viewloom
