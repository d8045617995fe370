// SPDX-License-Identifier: Apache-2.0
#include "trace/reflector.h"

#include <algorithm>

#include "gpu/barrier.h"
#include "picture/ray_sources.h"
#include "shaders/add_reflections.h"
#include "shaders/reflect.h"
#include "shared/kernel_constants.h"
#include "shared/lens_abi.h"
#include "shared/reflection_abi.h"
#include "trace/band_params.h"

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
                                            {abi::kBindingAlbedos, DescriptorKind::kStorage},
                                            {abi::kBindingLensPoints, DescriptorKind::kStorage},
                                            {abi::kBindingReflected, DescriptorKind::kStorage}};
constexpr DescriptorSlot kAddSlots[] = {{abi::kBindingReflected, DescriptorKind::kStorage},
                                        {abi::kBindingBand, DescriptorKind::kStorage}};

float focalOf(const AtlasLayout& layout) {
  const Intrinsics& intrinsics = layout.views.front().camera.intrinsics;
  return float(std::max(intrinsics.focal_px.x, intrinsics.focal_px.y));
}

}  // namespace

const ComputePass& Reflector::reflectPass(const Variant& variant) {
  std::lock_guard lock(mutex_);
  std::unique_ptr<ComputePass>& made = reflect_passes_[variant];
  if (!made) {
    const KernelConstant constants[] = {{abi::kIdReadsByAddress, variant.reads_by_address},
                                        {abi::kIdColorFormat, variant.color_format},
                                        {abi::kIdColorIsScaled, variant.color_is_scaled},
                                        {abi::kIdRays, variant.rays},
                                        {abi::kIdThroughLens, variant.through_lens}};
    made = std::make_unique<ComputePass>(*device_,
                                         ComputePassOptions{.spirv = reflect_spirv,
                                                            .push_bytes = sizeof(abi::TracePush),
                                                            .constants = constants,
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

void Reflector::record(Commands commands, const ReflectedRows& rows) {
  const StructureSlot& structure = rows.structure;
  const ComputePass& reflect =
      reflectPass({.reads_by_address = structure.readsByAddress(),
                   .color_format = colorFormat(structure.shape().color_storage),
                   .color_is_scaled = structure.shape().colorIsScaled(),
                   .rays = raySourceOf(*rows.job.layout),
                   .through_lens = rows.job.hasLens()});
  std::vector<Descriptor> descriptors(rows.params.begin(), rows.params.end());
  for (const Descriptor& descriptor :
       {structure.measuredDescriptor(), albedos_.descriptor(),
        wholeBuffer(abi::kBindingReflected, rows.reflected),
        structure.structure().asTexels(abi::kBindingStructure),
        structure.structure().asHalfTexels(abi::kBindingStructureHalves),
        structure.color().asTexels(abi::kBindingColor),
        structure.surface()->asTexels(abi::kBindingSurface)}) {
    descriptors.push_back(descriptor);
  }
  recordComputeBarrier(commands);
  reflect.recordDescriptors(commands, descriptors);
  reflect.record(commands, rows.push, groupCount(rows.push.atlas_width_px), rows.row_count);
  recordComputeBarrier(commands);
}

void Reflector::recordAdd(Commands commands, const TraceJob& job, const ReflectedTarget& target) {
  const AtlasLayout& layout = *job.layout;
  const Descriptor descriptors[] = {wholeBuffer(abi::kBindingReflected, target.reflected),
                                    wholeBuffer(abi::kBindingBand, target.rgba)};
  const ComputePass& add = addPass();
  add.recordDescriptors(commands, descriptors);
  add.record(commands,
             abi::AddReflectionsPush{.linear = addressWords(target.linear_address),
                                     .atlas_width_px = layout.size_px.width,
                                     .first_row = target.rows.first_row,
                                     .row_count = target.rows.row_count,
                                     .tile_size_px = packSize(layout.tile_size_px),
                                     .padding_top_px = layout.padding_top_px,
                                     .is_filtered = job.reflection->is_filtered,
                                     .focal_px = focalOf(layout)},
             groupCount(layout.size_px.width), target.rows.row_count);
  recordComputeBarrier(commands);
}

}  // namespace viewloom
