// SPDX-License-Identifier: Apache-2.0
#include "trace/lens_gatherer.h"

#include "gpu/barrier.h"
#include "shaders/gather_lens.h"
#include "shaders/list_met.h"
#include "shared/kernel_constants.h"
#include "shared/lens_abi.h"
#include "trace/band_params.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kListSlots[] = {{abi::kBindingStructure, DescriptorKind::kTexels},
                                         {abi::kBindingViews, DescriptorKind::kStorage},
                                         {abi::kBindingMet, DescriptorKind::kStorage},
                                         {abi::kBindingMetLists, DescriptorKind::kStorage},
                                         {abi::kBindingIncomplete, DescriptorKind::kStorage}};
constexpr DescriptorSlot kGatherSlots[] = {{abi::kBindingStructure, DescriptorKind::kTexels},
                                           {abi::kBindingStructureHalves, DescriptorKind::kTexels},
                                           {abi::kBindingColor, DescriptorKind::kTexels},
                                           {abi::kBindingMeasured, DescriptorKind::kUniform},
                                           {abi::kBindingViews, DescriptorKind::kStorage},
                                           {abi::kBindingExtras, DescriptorKind::kUniform},
                                           {abi::kBindingBand, DescriptorKind::kStorage},
                                           {abi::kBindingMetLists, DescriptorKind::kStorage},
                                           {abi::kBindingLensPoints, DescriptorKind::kStorage},
                                           {abi::kBindingSums, DescriptorKind::kStorage}};

// `color`: nullptr where none is read.
abi::GatherPush describeGather(const StructureSlot& structure, const LayeredBuffer* color,
                               const TraceJob& job, const GatherRows& rows, MetRound round) {
  const AtlasLayout& layout = *job.layout;
  const uint32_t border = job.outside_fill == OutsideFill::kBorder ? abi::kFillBorder : 0;
  abi::GatherPush push{.layers = {},
                       .color = {},
                       .source_size_px = packSize(structure.shape().depth_px),
                       .layer_count = structure.shape().layerCount(),
                       .atlas_width_px = layout.size_px.width,
                       .first_row = rows.band.first_row,
                       .row_count = rows.band.row_count,
                       .tile_size_px = packSize(layout.tile_size_px),
                       .tile_grid = packSize({layout.columns, layout.rows}),
                       .padding_top_px = layout.padding_top_px,
                       .fill = redFirst(job.background_rgb) | border,
                       .first_block_row = metBlocks(layout, rows.band).first_row,
                       .piece_row = rows.first_row,
                       .walked_count = layout.lens->walked_count,
                       .point_count = layout.lens->pointCount(),
                       .first_sample = round.first,
                       .end_sample = round.end};
  for (uint32_t i = 0; i < structure.shape().layerCount(); ++i) {
    push.layers[i] = addressWords(structure.structure().address(i));
    if (color) push.color[i] = addressWords(color->address(i));
  }
  return push;
}

}  // namespace

const ComputePass& LensGatherer::listPass(bool reads_by_address) {
  std::lock_guard lock(mutex_);
  std::unique_ptr<ComputePass>& made = list_passes_[reads_by_address];
  if (!made) {
    const KernelConstant constants[] = {{abi::kIdReadsByAddress, reads_by_address}};
    made = std::make_unique<ComputePass>(*device_,
                                         ComputePassOptions{.spirv = list_met_spirv,
                                                            .push_bytes = sizeof(abi::GatherPush),
                                                            .constants = constants,
                                                            .descriptors = kListSlots,
                                                            .debug_name = "list met sheets"});
  }
  return *made;
}

const ComputePass& LensGatherer::gatherPass(const Variant& variant) {
  std::lock_guard lock(mutex_);
  std::unique_ptr<ComputePass>& made = gather_passes_[variant];
  if (!made) {
    const KernelConstant constants[] = {{abi::kIdReadsByAddress, variant.reads_by_address},
                                        {abi::kIdWanted, variant.wanted},
                                        {abi::kIdColorFormat, variant.color_format},
                                        {abi::kIdColorIsScaled, variant.color_is_scaled},
                                        {abi::kIdIsExact, variant.is_exact}};
    made = std::make_unique<ComputePass>(*device_,
                                         ComputePassOptions{.spirv = gather_lens_spirv,
                                                            .push_bytes = sizeof(abi::GatherPush),
                                                            .constants = constants,
                                                            .descriptors = kGatherSlots,
                                                            .debug_name = "gather lens"});
  }
  return *made;
}

void LensGatherer::recordLists(Commands commands, const StructureSlot& structure,
                               const TraceJob& job, BandRows rows, const Descriptor& views,
                               const MetTarget& target, MetRound round) {
  const MetBlocks blocks = metBlocks(*job.layout, rows);
  recordComputeToTransfer(commands);
  commands.fill(target.incomplete, 0, sizeof(abi::IncompleteHead), 0);
  recordTransferToCompute(commands);
  if (blocks.row_count == 0) return;
  const Descriptor descriptors[] = {structure.structure().asTexels(abi::kBindingStructure), views,
                                    wholeBuffer(abi::kBindingMet, target.met),
                                    wholeBuffer(abi::kBindingMetLists, target.lists),
                                    wholeBuffer(abi::kBindingIncomplete, target.incomplete)};
  const ComputePass& list = listPass(structure.readsByAddress());
  list.recordDescriptors(commands, descriptors);
  list.record(commands, describeGather(structure, nullptr, job, {rows, 0, 0}, round),
              groupCount(blocks.per_row), blocks.row_count);
  recordComputeBarrier(commands);
}

void LensGatherer::record(Commands commands, const StructureSlot& structure,
                          const LayeredBuffer& color, uint32_t color_format, const TraceJob& job,
                          const GatherRows& rows, const std::vector<Descriptor>& params,
                          const GatherTarget& target) {
  const AtlasLayout& layout = *job.layout;
  if (metBlocks(layout, rows.band).row_count == 0) return;
  const ComputePass& gather = gatherPass({.reads_by_address = structure.readsByAddress(),
                                          .wanted = target.wants_linear ? abi::kWantLinear : 0,
                                          .color_format = color_format,
                                          .color_is_scaled = structure.shape().colorIsScaled(),
                                          .is_exact = layout.lens->is_exact});
  std::vector<Descriptor> descriptors = params;
  for (const Descriptor& descriptor :
       {structure.measuredDescriptor(), structure.structure().asTexels(abi::kBindingStructure),
        structure.structure().asHalfTexels(abi::kBindingStructureHalves),
        color.asTexels(abi::kBindingColor), wholeBuffer(abi::kBindingBand, target.band),
        wholeBuffer(abi::kBindingMetLists, target.lists),
        wholeBuffer(abi::kBindingSums, target.sums)}) {
    descriptors.push_back(descriptor);
  }
  gather.recordDescriptors(commands, descriptors);
  gather.record(commands, describeGather(structure, &color, job, rows, {}),
                groupCount(layout.tile_size_px.width * layout.columns),
                rows.end_row - rows.first_row);
  recordComputeBarrier(commands);
}

}  // namespace viewloom
