// SPDX-License-Identifier: Apache-2.0
#include "trace/mirror_pass.h"

#include <algorithm>

#include "gpu/commands.h"
#include "picture/ray_sources.h"
#include "shaders/add_reflections.h"
#include "shaders/reflect.h"
#include "shared/kernel_constants.h"
#include "shared/reflection_abi.h"
#include "trace/band_params.h"
#include "trace/mirrored_structure.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kAddSlots[] = {{abi::kBindingReflected, DescriptorKind::kStorage},
                                        {abi::kBindingBand, DescriptorKind::kStorage}};

float focalOf(const AtlasLayout& layout) {
  const Intrinsics& intrinsics = layout.views.front().camera.intrinsics;
  return float(std::max(intrinsics.focal_px.x, intrinsics.focal_px.y));
}

}  // namespace

ComputePass MirrorPass::makeReflectPass(const Device& device, const Variant& variant) {
  const KernelConstant constants[] = {{abi::kIdReadsByAddress, variant.reads_by_address},
                                      {abi::kIdColorFormat, variant.color_format},
                                      {abi::kIdColorIsScaled, variant.color_is_scaled},
                                      {abi::kIdRays, variant.rays},
                                      {abi::kIdThroughLens, variant.through_lens}};
  return {device,
          {.spirv = reflect_spirv,
           .push_bytes = sizeof(abi::TracePush),
           .takes_parts = true,
           .constants = constants,
           .descriptors = mirrorSlots({{abi::kBindingReflected, DescriptorKind::kStorage}}),
           .debug_name = "reflect"}};
}

MirrorPass::Variant MirrorPass::variantOf(const StructureSlot& structure, const TraceJob& job) {
  return {.reads_by_address = structure.readsByAddress(),
          .color_format = colorFormat(structure.shape().color_storage),
          .color_is_scaled = structure.shape().colorIsScaled(),
          .rays = raySourceOf(*job.layout),
          .through_lens = job.hasLens()};
}

void MirrorPass::addMissing(const StructureSlot& structure, const TraceJob& job,
                            MissingKernels& missing) {
  reflect_passes_.addMissing(variantOf(structure, job), missing);
}

void MirrorPass::record(Commands commands, const ReflectedRows& rows) {
  const ComputePass& reflect = reflect_passes_.get(variantOf(rows.structure, rows.job));
  std::vector<Descriptor> descriptors = mirrorDescriptors(rows.structure, rows.params, albedos_);
  descriptors.push_back(wholeBuffer(abi::kBindingReflected, rows.reflected));
  recordComputeBarrier(commands);
  reflect.recordDescriptors(commands, descriptors);
  reflect.recordColumns(commands, rows.push, rows.columns, rows.row_count);
  recordComputeBarrier(commands);
}

void MirrorPass::record(Commands commands, const Walk& walk, BandRows rows, const BandPart& part,
                        const TraceSlot& slot) {
  const BandRows piece{rows.first_row + part.first_row, part.end_row - part.first_row};
  abi::TracePush push = tracePush(walk, walk.structure.color(), piece);
  push.band_row = part.first_row;
  const std::vector<Descriptor> params = mirrorParams(walk, walk.index, slot);
  record(commands, {.structure = walk.structure,
                    .job = walk.job,
                    .row_count = piece.row_count,
                    .columns = groupsOf(part),
                    .push = push,
                    .params = params,
                    .reflected = slot.reflected()});
}

ComputePass MirroredLightPass::makePass(const Device& device, const std::monostate&) {
  return {device,
          {.spirv = add_reflections_spirv,
           .push_bytes = sizeof(abi::AddReflectionsPush),
           .takes_parts = true,
           .descriptors = kAddSlots,
           .debug_name = "add reflections"}};
}

void MirroredLightPass::record(Commands commands, const TraceJob& job,
                               const ReflectedTarget& target) {
  const AtlasLayout& layout = *job.layout;
  const Descriptor descriptors[] = {wholeBuffer(abi::kBindingReflected, target.reflected),
                                    wholeBuffer(abi::kBindingBand, target.rgba)};
  const ComputePass& add = pass_.get({});
  add.recordDescriptors(commands, descriptors);
  add.recordRows(commands,
                 abi::AddReflectionsPush{.linear = addressWords(target.linear_address),
                                         .atlas_width_px = layout.size_px.width,
                                         .first_row = target.rows.first_row,
                                         .row_count = target.rows.row_count,
                                         .tile_size_px = packSize(layout.tile_size_px),
                                         .padding_top_px = layout.padding_top_px,
                                         .is_filtered = !job.reflection->is_unfiltered,
                                         .focal_px = focalOf(layout)},
                 groupCount(layout.size_px.width), {target.span.first, target.span.end});
  recordComputeBarrier(commands);
}

}  // namespace viewloom
