// SPDX-License-Identifier: Apache-2.0
#include "bench/gpu/atlas_pass.h"

#include <algorithm>
#include <cstring>

#include "gpu/commands.h"
#include "shared/kernel_constants.h"
#include "structure/structure_layout.h"

namespace viewloom::bench {
namespace {

// The same as viewloom's (server/engine/walk/trace/walk_pass.cpp), but twice as many px: rivals
// gain 3 to 8 % by that on lavapipe.
constexpr uint32_t kColumnsForViewLanes = 5;
constexpr uint32_t kPixelsWithViewLanes = 16;
constexpr uint32_t kPixelsWithPixelLanes = 1;

// Rows of one dispatch are a multiple of this, so that the next one's binding is aligned for any
// device: 256 bytes.
constexpr uint32_t kRowAlignment = 64;
constexpr uint32_t kOpaqueBlack = 0xff000000;

uint32_t packSize(SizePx size) {
  return size.width | size.height << 16;
}

// 0xRRGGBB as the atlas has it.
uint32_t redFirst(uint32_t rgb) {
  return (rgb >> 16 & 0xff) | (rgb & 0xff00) | (rgb & 0xff) << 16;
}

uint64_t rowBytes(const BenchLoad& load) {
  return uint64_t{load.job.layout->size_px.width} * sizeof(uint32_t);
}

uint32_t rowsPerDispatch(const Device& device, const BenchLoad& load) {
  const uint64_t rows = device.info().limits.storage_bytes_max / rowBytes(load);
  const uint32_t height = load.job.layout->size_px.height;
  return rows >= height ? height : uint32_t(rows / kRowAlignment * kRowAlignment);
}

abi::RivalPush describe(const BenchLoad& load) {
  const AtlasLayout& layout = *load.job.layout;
  const LoadSource& source = load.source;
  const bool has_border = load.job.outside_fill == OutsideFill::kBorder;
  return {.source_size_px = packSize(source.size_px),
          .layer_count = uint32_t(source.inv_z.size()),
          .atlas_width_px = layout.size_px.width,
          .first_row = 0,
          .tile_size_px = packSize(layout.tile_size_px),
          .tile_grid = packSize({layout.columns, layout.rows}),
          .padding_top_px = layout.padding_top_px,
          .fill = redFirst(load.job.background_rgb) | (has_border ? abi::kFillBorder : 0),
          .inv_z_near = std::max(source.inv_z_max, abi::kInvZNearMin) * abi::kInvZNearMargin,
          .kappa = {source.kappa.least, source.kappa.share, source.kappa.from},
          .box_stride = 0};
}

}  // namespace

bool fitsAtlasPass(const Device& device, const BenchLoad& load) {
  const DeviceLimits& limits = device.info().limits;
  const FrameShape shape = shapeOf(*load.frame);
  const bool is_per_px =
      std::all_of(shape.color_px.begin(), shape.color_px.end(),
                  [&](const SizePx& color_px) { return color_px == shape.depth_px; });
  const uint64_t depth_bytes = structureLayout(shape.depth_px).invZBytes() * shape.layerCount();
  return shape.color_storage == ColorStorage::kRgba8Srgb && is_per_px &&
         raysArePlain(load.job.tiles, load.job.layout->tile_size_px, load.source.inv_z_max) &&
         depth_bytes <= limits.storage_bytes_max &&
         depth_bytes / sizeof(float) <= limits.texel_count_max;
}

AtlasPass::AtlasPass(const Device& device, const BenchLoad& load, std::span<const uint32_t> spirv,
                     std::span<const DescriptorSlot> slots, const char* name)
    : device_(&device),
      load_(&load),
      lanes_are_views_(load.job.layout->columns >= kColumnsForViewLanes),
      pixels_(lanes_are_views_ ? kPixelsWithViewLanes : kPixelsWithPixelLanes),
      rows_per_dispatch_(rowsPerDispatch(device, load)),
      push_(describe(load)),
      color_(makePass(spirv, slots, false, name)),
      inv_z_(makePass(spirv, slots, true, name)),
      views_(device, {.size_bytes = load.job.tiles.size() * sizeof(abi::ViewParams),
                      .intent = MemoryIntent::kUpload,
                      .debug_name = "rival views"}),
      atlas_(device, load.job.layout->size_px.area() * sizeof(uint32_t), "rival atlas"),
      timeline_(device),
      recorder_(device) {
  std::memcpy(views_.mapped().data(), load.job.tiles.data(), views_.sizeBytes());
  clear();
}

ComputePass AtlasPass::makePass(std::span<const uint32_t> spirv,
                                std::span<const DescriptorSlot> slots, bool writes_inv_z,
                                const char* name) const {
  std::vector<DescriptorSlot> all(slots.begin(), slots.end());
  all.push_back({abi::kBindingViews, DescriptorKind::kStorage});
  all.push_back({abi::kBindingBand, DescriptorKind::kStorage});
  const AtlasLayout& layout = *load_->job.layout;
  const bool has_fours =
      pixels_ % 4 == 0 && layout.tile_size_px.width % 4 == 0 && layout.size_px.width % 4 == 0;
  const KernelConstant constants[] = {{abi::kIdFree, writes_inv_z},
                                      {abi::kIdPixelsPerInvocation, pixels_},
                                      {abi::kIdLanesAreViews, lanes_are_views_},
                                      {abi::kIdFree + 1, has_fours}};
  return ComputePass(*device_, {.spirv = spirv,
                                .push_bytes = sizeof(abi::RivalPush),
                                .constants = constants,
                                .descriptors = all,
                                .debug_name = name});
}

void AtlasPass::bind(std::vector<Descriptor> descriptors, uint32_t box_stride) {
  descriptors_ = std::move(descriptors);
  push_.box_stride = box_stride;
}

// Pixels outside all views stay black.
void AtlasPass::clear() {
  const Commands commands = recorder_.begin();
  commands.fill(atlas_.target(), kOpaqueBlack);
  timeline_.wait(recorder_.submit(timeline_));
}

void AtlasPass::run(const ComputePass& pass) {
  const AtlasLayout& layout = *load_->job.layout;
  const uint32_t invocations = (layout.tile_size_px.width + pixels_ - 1) / pixels_ * layout.columns;
  const Commands commands = recorder_.begin();
  for (uint32_t row = 0; row < layout.size_px.height; row += rows_per_dispatch_) {
    const uint32_t rows = std::min(rows_per_dispatch_, layout.size_px.height - row);
    std::vector<Descriptor> descriptors = descriptors_;
    descriptors.push_back({.binding = abi::kBindingViews,
                           .kind = DescriptorKind::kStorage,
                           .buffer = &views_,
                           .size_bytes = views_.sizeBytes()});
    descriptors.push_back({.binding = abi::kBindingBand,
                           .kind = DescriptorKind::kStorage,
                           .buffer = &atlas_.target(),
                           .offset_bytes = row * rowBytes(*load_),
                           .size_bytes = rows * rowBytes(*load_)});
    abi::RivalPush push = push_;
    push.first_row = row;
    pass.recordDescriptors(commands, descriptors);
    pass.record(commands, push, (invocations + abi::kTraceGroupSize - 1) / abi::kTraceGroupSize,
                rows);
  }
  recordComputeToTransfer(commands);
  atlas_.recordReadback(commands, rowBytes(*load_) * layout.size_px.height);
  recordTransferToHost(commands);
  recordComputeToHost(commands);
  timeline_.wait(recorder_.submit(timeline_));
}

Picture AtlasPass::picture() {
  Picture picture;
  const size_t area = load_->job.layout->size_px.area();
  picture.inv_z.resize(area);
  picture.rgba.resize(area);
  run(inv_z_);
  std::memcpy(picture.inv_z.data(), atlas_.bytes().data(), area * sizeof(float));
  clear();
  run(color_);
  std::memcpy(picture.rgba.data(), atlas_.bytes().data(), area * sizeof(uint32_t));
  return picture;
}

}  // namespace viewloom::bench
