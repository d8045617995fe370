// SPDX-License-Identifier: Apache-2.0
#include "trace/view_tracer.h"

#include <algorithm>
#include <cstring>

#include "base/check.h"
#include "gpu/barrier.h"
#include "shaders/walk_views.h"
#include "trace/band_params.h"
#include "trace/ray_sources.h"

namespace viewloom {
namespace {

// With fewer columns than lanes of a subgroup, neighbouring lanes take neighbouring runs of a view
// instead of neighbouring views.
constexpr uint32_t kColumnsForViewLanes = 5;
// A run traces a px more at both of its ends.
constexpr uint32_t kPixelsOnHardware = 8;
// A software device pays more for an invocation than for a ray, and has few lanes to fill; as long
// as the px still share a bound where they start, which is found in a few nodes of 32 px. Lanes
// that are runs of one view have more in common if these are shorter.
constexpr uint32_t kPixelsOnSoftware[] = {60, 32, 16};
constexpr uint32_t kPixelsOnSoftwareInLanes = 16;
constexpr uint32_t kRunWidthMax_px = 384;  // of the source

// Of several sources each says from where on it has seen rays, which what others see is compared
// with: that may be nearer than anything it holds itself, as where that is nothing but sky. With
// this, eyes count as in the plane up to 2^-30 m from it: there they are one with it (abi::kAtEye).
constexpr double kInvZOfOthers = 1;  // 1/m

constexpr uint32_t kOpaqueBlack = 0xff000000;

constexpr DescriptorSlot kSlots[] = {{abi::kBindingStructure, DescriptorKind::kTexels},
                                     {abi::kBindingStructureHalves, DescriptorKind::kTexels},
                                     {abi::kBindingColor, DescriptorKind::kTexels},
                                     {abi::kBindingMeasured, DescriptorKind::kUniform},
                                     {abi::kBindingViews, DescriptorKind::kStorage},
                                     {abi::kBindingExtras, DescriptorKind::kUniform},
                                     {abi::kBindingBand, DescriptorKind::kStorage}};

// Of one view, neighbours in a row. Views see about what the source sees.
uint32_t pixelsOfRun(const DeviceInfo& device, const StructureSlot& structure,
                     const AtlasLayout& layout) {
  if (!device.is_software) return kPixelsOnHardware;
  if (layout.columns < kColumnsForViewLanes) return kPixelsOnSoftwareInLanes;
  for (const uint32_t pixels : kPixelsOnSoftware) {
    const uint64_t run_width_px =
        uint64_t{pixels} * structure.shape().depth_px.width / layout.tile_size_px.width;
    if (run_width_px <= kRunWidthMax_px) return pixels;
  }
  return kPixelsOnHardware;
}

uint32_t shownBeside(const TraceJob& job) {
  uint32_t flags = 0;
  for (const abi::ViewParams& tile : job.tilesOf(0)) flags |= tile.shows;
  return flags;
}

bool hasUnusedPixels(const TraceJob& job) {
  const AtlasLayout& layout = *job.layout;
  return job.hasEyesBeside() || layout.padding_right_px > 0 || layout.padding_top_px > 0 ||
         layout.views.size() < size_t{layout.columns} * layout.rows;
}

abi::Address addressOf(const ReadablePlane& plane) {
  return plane.isEmpty() ? abi::Address{0, 0} : addressWords(plane.target().address());
}

// What no view covers is black; every plane is cleared, so that no byte of an older band is left.
void recordClear(vk::CommandBuffer commands, const ReadablePlane& plane, uint32_t value) {
  if (!plane.isEmpty()) commands.fillBuffer(plane.target().handle(), 0, VK_WHOLE_SIZE, value);
}

}  // namespace

ViewTracer::ViewTracer(const Device& device)
    : device_(&device),
      averager_(device),
      packer_(device),
      blender_(device),
      gatherer_(device),
      reflector_(device) {}

// A software device has nothing to read back, and packing px costs it more than converting them
// costs the encoder (shaders/README.md, Bands for the encoder).
ColorForm ViewTracer::colorForm(ColorForm wanted) const {
  return device_->info().is_software ? ColorForm::kRgba : wanted;
}

const ComputePass& ViewTracer::pass(const Variant& variant) {
  std::lock_guard lock(mutex_);
  std::unique_ptr<ComputePass>& made = passes_[variant];
  if (!made) {
    static_assert(abi::kOwnConstants == 2);
    const uint32_t constants[] = {variant.reads_by_address,
                                  0,
                                  variant.wanted,
                                  variant.color_format,
                                  variant.pixels_per_invocation,
                                  variant.lanes_are_views,
                                  variant.color_is_scaled,
                                  variant.rays_are_plain,
                                  variant.eyes_in_plane,
                                  variant.is_one_of_several,
                                  variant.is_cube_face,
                                  variant.rays,
                                  variant.shown_beside,
                                  variant.through_lens};
    made = std::make_unique<ComputePass>(*device_,
                                         ComputePassOptions{.spirv = walk_views_spirv,
                                                            .push_bytes = sizeof(abi::TracePush),
                                                            .specialization = constants,
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
      .lens_points = addressWords(job.hasLens() ? slot.lensAddress(job, part / job.walk_count) : 0),
      .met = addressWords(job.mayGather() ? slot.metAddress(part) : 0)};
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
  const std::span points(job.layout->lens_points);
  std::memcpy(to + TraceSlot::lensOffset(job), points.data(), points.size_bytes());
}

std::vector<Descriptor> ViewTracer::describeParams(const TraceJob& job, uint32_t walk,
                                                   uint32_t sample, const TraceSlot& slot) {
  const std::span<const abi::ViewParams> tiles = job.tilesOf(walk, sample);
  const uint32_t part = sample * job.walk_count + walk;
  const uint32_t part_count = job.sample_count * job.walk_count;
  return {{.binding = abi::kBindingViews,
           .kind = DescriptorKind::kStorage,
           .buffer = slot.params_.handle(),
           .offset_bytes = TraceSlot::tilesOffset(part, part_count, tiles.size()),
           .size_bytes = tiles.size_bytes()},
          {.binding = abi::kBindingExtras,
           .kind = DescriptorKind::kUniform,
           .buffer = slot.params_.handle(),
           .offset_bytes = TraceSlot::extrasOffset(part),
           .size_bytes = sizeof(abi::TraceExtras)}};
}

abi::TracePush ViewTracer::describeBand(const Walk& walk, const LayeredBuffer& color,
                                        BandRows rows) {
  const AtlasLayout& layout = *walk.job.layout;
  const StructureSlot& structure = walk.structure;
  const uint32_t border = walk.job.outside_fill == OutsideFill::kBorder ? abi::kFillBorder : 0;
  abi::TracePush push{.layers = {},
                      .color = {},
                      .source_size_px = packSize(structure.shape().depth_px),
                      .layer_count = structure.shape().layerCount(),
                      .atlas_width_px = layout.size_px.width,
                      .first_row = rows.first_row,
                      .tile_size_px = packSize(layout.tile_size_px),
                      .tile_grid = packSize({layout.columns, layout.rows}),
                      .padding_top_px = layout.padding_top_px,
                      .fill = redFirst(walk.job.background_rgb) | border};
  for (uint32_t i = 0; i < structure.shape().layerCount(); ++i) {
    push.layers[i] = addressWords(structure.structure().address(i));
    push.color[i] = addressWords(color.address(i));
  }
  return push;
}

void ViewTracer::recordWalk(vk::CommandBuffer commands, const Walk& walk, BandRows rows) {
  const AtlasLayout& layout = *walk.job.layout;
  const StructureSlot& structure = walk.structure;
  const TileRays rays = raysOf(walk.job, walk.index, walk.rays.sample);
  const double inv_z_max = structure.stats().inv_z_max;
  const bool lanes_are_views = layout.columns >= kColumnsForViewLanes;
  const uint32_t pixels = pixelsOfRun(device_->info(), structure, layout);
  const bool is_one_of_several = walk.job.walk_count > 1;
  const bool eyes_in_plane = eyesAreInPlane(
      rays.tiles, is_one_of_several ? std::max(inv_z_max, kInvZOfOthers) : inv_z_max);
  // Of rays between others, plain as well if they are linear in their eye, all at one depth.
  const bool rays_are_plain =
      (eyes_in_plane || !rays.are_bounds) && raysArePlain(rays.tiles, rays.tile_px, inv_z_max);
  const ColorAverager::Color color =
      averager_.record(commands, structure, colorReach(rays.tiles, rays.tile_px));
  const ComputePass& walk_views =
      pass({.reads_by_address = structure.readsByAddress(),
            .wanted = is_one_of_several ? 0 : walk.rays.wanted,
            .color_format = color.format,
            .pixels_per_invocation = pixels,
            .lanes_are_views = lanes_are_views,
            .color_is_scaled = structure.shape().colorIsScaled(),
            .rays_are_plain = rays_are_plain,
            .eyes_in_plane = eyes_in_plane,
            .is_one_of_several = is_one_of_several,
            .is_cube_face = structure.shape().is_cube_face,
            .rays = raySourceOf(layout),
            .shown_beside = is_one_of_several ? 0 : shownBeside(walk.job),
            .through_lens = walk.rays.through_lens});
  std::vector<Descriptor> descriptors =
      describeParams(walk.job, walk.index, walk.rays.sample, walk.slot);
  for (const Descriptor& descriptor :
       {structure.measuredDescriptor(), walk.target,
        structure.structure().asTexels(abi::kBindingStructure),
        structure.structure().asHalfTexels(abi::kBindingStructureHalves),
        color.texels.asTexels(abi::kBindingColor)}) {
    descriptors.push_back(descriptor);
  }
  walk_views.recordDescriptors(commands, descriptors);
  walk_views.record(commands, describeBand(walk, color.texels, rows),
                    groupCount((layout.tile_size_px.width + pixels - 1) / pixels * layout.columns),
                    rows.row_count);
  if (walk.job.reflects()) recordReflections(commands, walk, rows);
}

void ViewTracer::recordBand(vk::CommandBuffer commands,
                            std::span<const StructureSlot* const> structures, const TraceJob& job,
                            BandRows rows, TraceSlot& slot, GpuTimer* timer) {
  const AtlasLayout& layout = *job.layout;
  VIEWLOOM_CHECK(
      slot.shape_.width_px >= layout.size_px.width && slot.shape_.row_count_max >= rows.row_count &&
      slot.shape_.tile_count_max >= job.tilesOf(0).size() &&
      slot.shape_.walk_count >= job.walk_count && slot.shape_.sample_count >= job.sample_count &&
      slot.shape_.lens_point_count >= layout.lens_points.size() &&
      (slot.shape_.reflects || !job.reflects()));
  VIEWLOOM_CHECK(structures.size() == job.walk_count);
  slot.band_px_ = {layout.size_px.width, rows.row_count};
  const uint64_t area_px = slot.band_px_.area();
  fillParams(structures, job, slot);

  if (timer) timer->recordBegin(commands, "trace");
  commands.copyBuffer(slot.upload_.handle(), slot.params_.handle(),
                      vk::BufferCopy{.size = TraceSlot::lensOffset(job) +
                                             std::span(job.layout->lens_points).size_bytes()});
  recordClear(commands, slot.counters_, 0);
  if (hasUnusedPixels(job)) {
    commands.fillBuffer(slot.sampleTarget(job).handle(), 0, VK_WHOLE_SIZE, kOpaqueBlack);
    for (const ReadablePlane* plane : {&slot.depth_, &slot.mask_, &slot.linear_, &slot.records_}) {
      recordClear(commands, *plane, 0);
    }
  }
  recordTransferToCompute(commands);
  recordSamples(commands, structures, job, rows, slot);
  const ColorForm form = slot.shape_.outputs.color;
  if (form != ColorForm::kRgba) {
    packer_.record(commands, slot.rgba(), slot.color_.target(), slot.band_px_, form);
  }
  if (timer) timer->recordEnd(commands);

  recordComputeToTransfer(commands);
  slot.color_.recordReadback(commands, slot.colorBytes());
  slot.depth_.recordReadback(commands, area_px * sizeof(float));
  slot.mask_.recordReadback(commands, area_px);
  slot.linear_.recordReadback(commands, area_px * 4 * sizeof(float));
  slot.records_.recordReadback(commands, area_px * sizeof(abi::RayRecord));
  slot.counters_.recordReadback(commands, kCounterCount * sizeof(uint32_t));
  recordTransferToHost(commands);
  recordComputeToHost(commands);
}

}  // namespace viewloom
