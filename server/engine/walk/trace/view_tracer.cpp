// SPDX-License-Identifier: Apache-2.0
#include "trace/view_tracer.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "base/check.h"
#include "gpu/barrier.h"
#include "picture/ray_sources.h"
#include "shaders/walk_views.h"
#include "shared/kernel_constants.h"
#include "shared/lens_abi.h"
#include "trace/band_params.h"
#include "trace/met_blocks.h"
#include "trace/px_runs.h"

namespace viewloom {
namespace {

// Of several sources each says from where on it has seen rays, which what others see is compared
// with: that may be nearer than anything it holds itself, as where that is nothing but sky. With
// this, eyes count as in the plane up to 2^-30 m from it: there they are one with it (abi::kAtEye).
constexpr double kInvZOfOthers = 1;  // 1/m

constexpr DescriptorSlot kSlots[] = {{abi::kBindingStructure, DescriptorKind::kTexels},
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

abi::Address addressOf(const ReadablePlane& plane) {
  return plane.isEmpty() ? abi::Address{0, 0} : addressWords(plane.target().address());
}

// Every binding of a kernel has to have a buffer, also one that its variant does not use: there
// stands what it writes anyhow, so that walks beside each other need not wait.
Descriptor usedOr(uint32_t binding, bool is_used, const Buffer& buffer, Descriptor target) {
  target.binding = binding;
  return is_used ? wholeBuffer(binding, buffer) : target;
}

}  // namespace

ViewTracer::ViewTracer(const Device& device)
    : device_(&device),
      averager_(device),
      packer_(device),
      blender_(device),
      gatherer_(device),
      reflector_(device),
      path_reflector_(device) {}

// A software device has nothing to read back, and packing px costs it more than converting them
// costs the encoder (shaders/README.md, Bands for the encoder).
ColorForm ViewTracer::colorForm(ColorForm wanted) const {
  return device_->info().is_software ? ColorForm::kRgba : wanted;
}

const ComputePass& ViewTracer::pass(const Variant& variant) {
  std::lock_guard lock(mutex_);
  std::unique_ptr<ComputePass>& made = passes_[variant];
  if (!made) {
    const KernelConstant constants[] = {
        {abi::kIdReadsByAddress, variant.reads_by_address},
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
    made = std::make_unique<ComputePass>(*device_,
                                         ComputePassOptions{.spirv = walk_views_spirv,
                                                            .push_bytes = sizeof(abi::TracePush),
                                                            .constants = constants,
                                                            .descriptors = kSlots,
                                                            .debug_name = "walk views"});
  }
  return *made;
}

abi::TraceExtras ViewTracer::describeExtras(const StructureSlot& structure, const TraceJob& job,
                                            uint32_t part, const TraceSlot& slot) {
  const uint32_t walk = part % job.walk_count;
  abi::TraceExtras extras{
      .depth = addressOf(slot.depth_),
      .mask = addressOf(slot.mask_),
      .linear = addressOf(slot.linear_),
      .records = addressWords(slot.recordsAddress()),
      .counters = addressOf(slot.counters_),
      .color_size_px = {},
      .color_stride = structure.colorStride(),
      .focal_px = abi::vec2(structure.sourceCamera().intrinsics.focal_px),
      .principal_px = abi::vec2(structure.sourceCamera().intrinsics.principal_px),
      .eye_axes = job.hasEyesBeside() ? job.bounds[walk].eye_axes : abi::EyeAxes{},
      .microlenses = microlensesOf(*job.layout),
      .lenticular = lenticularEyesOf(*job.layout, part / job.walk_count),
      .depth_scale = scaleOf(job.layout->depth_codes.value_or(DepthCodes{})),
      .met = addressWords(job.mayGather() ? slot.metAddress(part) : 0),
      .sample_index = part / job.walk_count};
  for (uint32_t i = 0; i < structure.shape().layerCount(); ++i) {
    extras.color_size_px[i] = packSize(structure.shape().color_px[i]);
  }
  return extras;
}

void ViewTracer::fillParams(std::span<const StructureSlot* const> structures, const TraceJob& job,
                            TraceSlot& slot) {
  std::byte* const to = slot.upload_.mapped().data();
  const uint32_t part_count = job.sample_count * job.walk_count;
  for (uint32_t part = 0; part < part_count; ++part) {
    const uint32_t walk = part % job.walk_count;
    const abi::TraceExtras extras = describeExtras(*structures[walk], job, part, slot);
    const std::span<const abi::ViewParams> tiles = job.tilesOf(walk, part / job.walk_count);
    std::memcpy(to + TraceSlot::extrasOffset(part), &extras, sizeof extras);
    std::memcpy(to + TraceSlot::tilesOffset(part, part_count, tiles.size()), tiles.data(),
                tiles.size_bytes());
  }
  // Each sample's point, and those of the second stage after them.
  const auto points = std::as_bytes(std::span(job.layout->lens_points));
  std::ranges::copy(points, to + TraceSlot::lensOffset(job));
}

std::vector<Descriptor> ViewTracer::describeParams(const TraceJob& job, uint32_t walk,
                                                   uint32_t sample, const TraceSlot& slot) {
  const std::span<const abi::ViewParams> tiles = job.tilesOf(walk, sample);
  const uint32_t part = sample * job.walk_count + walk;
  const uint32_t part_count = job.sample_count * job.walk_count;
  return {{.binding = abi::kBindingViews,
           .kind = DescriptorKind::kStorage,
           .buffer = &slot.params_,
           .offset_bytes = TraceSlot::tilesOffset(part, part_count, tiles.size()),
           .size_bytes = tiles.size_bytes()},
          {.binding = abi::kBindingExtras,
           .kind = DescriptorKind::kUniform,
           .buffer = &slot.params_,
           .offset_bytes = TraceSlot::extrasOffset(part),
           .size_bytes = sizeof(abi::TraceExtras)}};
}

abi::TracePush ViewTracer::describeBand(const Walk& walk, const LayeredBuffer& color,
                                        BandRows rows) {
  const AtlasLayout& layout = *walk.job.layout;
  const StructureSlot& structure = walk.structure;
  const uint32_t border = walk.job.outside_fill == OutsideFill::kBorder ? abi::kFillBorder : 0;
  const uint32_t first = walk.rays.sample == 0 ? abi::kFillFirst : 0;
  abi::TracePush push{.layers = {},
                      .color = {},
                      .source_size_px = packSize(structure.shape().depth_px),
                      .layer_count = structure.shape().layerCount(),
                      .atlas_width_px = layout.size_px.width,
                      .first_row = rows.first_row,
                      .tile_size_px = packSize(layout.tile_size_px),
                      .tile_grid = packSize({layout.columns, layout.rows}),
                      .padding_top_px = layout.padding_top_px,
                      .fill = redFirst(walk.job.background_rgb) | border | first,
                      .row_count = rows.row_count,
                      .first_block_row = metBlocks(layout, rows).first_row,
                      .band_row = 0,
                      .bounce = 0,
                      .sample_index = 0};
  for (uint32_t i = 0; i < structure.shape().layerCount(); ++i) {
    push.layers[i] = addressWords(structure.structure().address(i));
    push.color[i] = addressWords(color.address(i));
  }
  return push;
}

ViewTracer::Variant ViewTracer::variantOf(const Walk& walk, uint32_t color_format) const {
  const AtlasLayout& layout = *walk.job.layout;
  const StructureSlot& structure = walk.structure;
  const TileRays rays = raysOf(walk.job, walk.index, walk.rays.sample);
  const double inv_z_max = structure.stats().inv_z_max;
  const bool is_one_of_several = walk.job.walk_count > 1;
  const bool eyes_in_plane = eyesAreInPlane(
      rays.tiles, is_one_of_several ? std::max(inv_z_max, kInvZOfOthers) : inv_z_max);
  // Of rays between others, plain as well if they are linear in their eye, all at one depth.
  const bool rays_are_plain =
      (eyes_in_plane || !rays.are_bounds) && raysArePlain(rays.tiles, rays.tile_px, inv_z_max);
  return {.reads_by_address = structure.readsByAddress(),
          .wanted = is_one_of_several ? 0 : walk.rays.wanted,
          .color_format = color_format,
          .pixels_per_invocation = pixelsOfRun(device_->info(), structure, layout),
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
          .lists_unfinished = device_->info().is_software && !walk.rays.areListed()};
}

void ViewTracer::recordWalk(Commands commands, const Walk& walk, BandRows rows) {
  const StructureSlot& structure = walk.structure;
  const TileRays rays = raysOf(walk.job, walk.index, walk.rays.sample);
  const ColorAverager::Color color =
      averager_.record(commands, structure, colorReach(rays.tiles, rays.tile_px));
  std::vector<Descriptor> descriptors =
      describeParams(walk.job, walk.index, walk.rays.sample, walk.slot);
  for (const Descriptor& descriptor :
       {structure.measuredDescriptor(), walk.target,
        walk.slot.lensDescriptor(walk.job, walk.rays.sample),
        structure.structure().asTexels(abi::kBindingStructure),
        structure.structure().asHalfTexels(abi::kBindingStructureHalves),
        color.texels.asTexels(abi::kBindingColor)}) {
    descriptors.push_back(descriptor);
  }
  const bool sums = (walk.rays.wanted & abi::kWantSum) != 0;
  descriptors.push_back(usedOr(abi::kBindingSums, sums, walk.slot.sums_, walk.target));
  const bool are_listed = walk.rays.areListed();
  descriptors.push_back(usedOr(abi::kBindingIncomplete, are_listed || walk.rays.lists_hidden,
                               walk.slot.incomplete_, walk.target));
  const Variant variant = variantOf(walk, color.format);
  const bool lists_unfinished = variant.lists_unfinished != 0;
  descriptors.push_back(
      usedOr(abi::kBindingUnfinished, lists_unfinished, walk.slot.unfinished_, walk.target));
  if (lists_unfinished) recordEmptyList(commands, walk.slot.unfinished_);
  const ComputePass& walk_views = pass(variant);
  walk_views.recordDescriptors(commands, descriptors);
  abi::TracePush push = describeBand(walk, color.texels, rows);
  constexpr uint64_t kGroupsOffset = offsetof(abi::IncompleteHead, group_count);
  if (are_listed) {
    walk_views.recordIndirect(commands, push, walk.slot.incomplete_, kGroupsOffset);
    return;
  }
  const AtlasLayout& layout = *walk.job.layout;
  const uint32_t pixels = variant.pixels_per_invocation;
  const uint32_t runs = (layout.tile_size_px.width + pixels - 1) / pixels * layout.columns;
  walk_views.record(commands, push, groupCount(runs), rows.row_count);
  if (!lists_unfinished) return;
  recordComputeBarrier(commands);
  push.fill |= abi::kFillUnfinished;
  walk_views.recordIndirect(commands, push, walk.slot.unfinished_, kGroupsOffset);
}

}  // namespace viewloom
