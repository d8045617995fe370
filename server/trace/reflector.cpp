// SPDX-License-Identifier: Apache-2.0
#include "trace/reflector.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "gpu/barrier.h"
#include "shaders/add_reflections.h"
#include "shaders/reflect.h"
#include "shared/reflection_abi.h"
#include "trace/band_params.h"
#include "trace/ray_sources.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kReflectSlots[] = {{abi::kBindingStructure, DescriptorKind::kTexels},
                                            {abi::kBindingStructureHalves, DescriptorKind::kTexels},
                                            {abi::kBindingColor, DescriptorKind::kTexels},
                                            {abi::kBindingSurface, DescriptorKind::kTexels},
                                            {abi::kBindingMeasured, DescriptorKind::kUniform},
                                            {abi::kBindingViews, DescriptorKind::kStorage},
                                            {abi::kBindingExtras, DescriptorKind::kUniform},
                                            {abi::kBindingReflection, DescriptorKind::kUniform},
                                            {abi::kBindingReflected, DescriptorKind::kStorage}};
constexpr DescriptorSlot kAddSlots[] = {{abi::kBindingReflected, DescriptorKind::kStorage},
                                        {abi::kBindingBand, DescriptorKind::kStorage}};

float linearFromCode(uint32_t code) {
  const float srgb = float(code & 0xff) / 255;
  return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

void fillSettings(const ReflectedBand& band) {
  const ReflectionSpec& spec = *band.job.reflection;
  abi::ReflectionSettings settings{.surfaces = {},
                                   .environment = {linearFromCode(spec.environment_rgb >> 16),
                                                   linearFromCode(spec.environment_rgb >> 8),
                                                   linearFromCode(spec.environment_rgb)},
                                   .tolerance_px = float(band.job.tolerance_px),
                                   .bounce_count = spec.bounce_count,
                                   .sample_count = spec.sample_count};
  for (uint32_t i = 0; i < band.structure.shape().layerCount(); ++i) {
    settings.surfaces[i] = addressWords(band.structure.surface()->address(i));
  }
  std::memcpy(band.settings.mapped().data(), &settings, sizeof settings);
}

float focalOf(const AtlasLayout& layout) {
  const Intrinsics& intrinsics = layout.views.front().camera.intrinsics;
  return float(std::max(intrinsics.focal_px.x, intrinsics.focal_px.y));
}

}  // namespace

const ComputePass& Reflector::reflectPass(const Variant& variant) {
  std::lock_guard lock(mutex_);
  std::unique_ptr<ComputePass>& made = reflect_passes_[variant];
  if (!made) {
    const uint32_t constants[] = {variant.reads_by_address, 0, variant.color_format,
                                  variant.color_is_scaled, variant.rays};
    made = std::make_unique<ComputePass>(*device_,
                                         ComputePassOptions{.spirv = reflect_spirv,
                                                            .push_bytes = sizeof(abi::TracePush),
                                                            .specialization = constants,
                                                            .descriptors = kReflectSlots,
                                                            .debug_name = "reflect"});
  }
  return *made;
}

const ComputePass& Reflector::addPass() {
  std::lock_guard lock(mutex_);
  if (!add_pass_) {
    add_pass_ = std::make_unique<ComputePass>(
        *device_, ComputePassOptions{.spirv = add_reflections_spirv,
                                     .push_bytes = sizeof(abi::AddReflectionsPush),
                                     .descriptors = kAddSlots,
                                     .debug_name = "add reflections"});
  }
  return *add_pass_;
}

void Reflector::record(vk::CommandBuffer commands, const ReflectedBand& band) {
  fillSettings(band);
  const StructureSlot& structure = band.structure;
  const AtlasLayout& layout = *band.job.layout;
  const ComputePass& reflect =
      reflectPass({.reads_by_address = structure.readsByAddress(),
                   .color_format = colorFormat(structure.shape().color_storage),
                   .color_is_scaled = structure.shape().colorIsScaled(),
                   .rays = raySourceOf(layout)});
  std::vector<Descriptor> descriptors(band.params.begin(), band.params.end());
  const Descriptor reflected = wholeBuffer(abi::kBindingReflected, band.reflected);
  for (const Descriptor& descriptor :
       {structure.measuredDescriptor(), reflected,
        structure.structure().asTexels(abi::kBindingStructure),
        structure.structure().asHalfTexels(abi::kBindingStructureHalves),
        structure.color().asTexels(abi::kBindingColor),
        structure.surface()->asTexels(abi::kBindingSurface),
        Descriptor{.binding = abi::kBindingReflection,
        .kind = DescriptorKind::kUniform,
        .buffer = band.settings.handle(),
        .size_bytes = band.settings.sizeBytes()}}) {
    descriptors.push_back(descriptor);
  }
  abi::TracePush push = band.push;
  for (uint32_t i = 0; i < structure.shape().layerCount(); ++i) {
    push.color[i] = addressWords(structure.color().address(i));
  }
  recordComputeBarrier(commands);
  reflect.recordDescriptors(commands, descriptors);
  reflect.record(commands, push, groupCount(layout.size_px.width), band.rows.row_count);
  recordComputeBarrier(commands);
  const Descriptor targets[] = {reflected, wholeBuffer(abi::kBindingBand, band.rgba)};
  const ComputePass& add = addPass();
  add.recordDescriptors(commands, targets);
  add.record(commands,
             abi::AddReflectionsPush{.linear = addressWords(band.linear_address),
                                     .atlas_width_px = layout.size_px.width,
                                     .first_row = band.rows.first_row,
                                     .row_count = band.rows.row_count,
                                     .tile_size_px = packSize(layout.tile_size_px),
                                     .padding_top_px = layout.padding_top_px,
                                     .is_filtered = band.job.reflection->is_filtered,
                                     .focal_px = focalOf(layout)},
             groupCount(layout.size_px.width), band.rows.row_count);
  recordComputeBarrier(commands);
}

}  // namespace viewloom
