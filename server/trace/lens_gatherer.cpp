// SPDX-License-Identifier: Apache-2.0
#include "trace/lens_gatherer.h"

#include "gpu/barrier.h"
#include "shaders/gather_lens.h"
#include "shaders/list_met.h"
#include "trace/band_params.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kListSlots[] = {{abi::kBindingMet, DescriptorKind::kStorage},
                                         {abi::kBindingMetLists, DescriptorKind::kStorage}};
constexpr DescriptorSlot kGatherSlots[] = {{abi::kBindingStructure, DescriptorKind::kTexels},
                                           {abi::kBindingStructureHalves, DescriptorKind::kTexels},
                                           {abi::kBindingColor, DescriptorKind::kTexels},
                                           {abi::kBindingMeasured, DescriptorKind::kUniform},
                                           {abi::kBindingViews, DescriptorKind::kStorage},
                                           {abi::kBindingExtras, DescriptorKind::kUniform},
                                           {abi::kBindingBand, DescriptorKind::kStorage},
                                           {abi::kBindingMetLists, DescriptorKind::kStorage},
                                           {abi::kBindingSums, DescriptorKind::kStorage}};

abi::GatherPush describeGather(const StructureSlot& structure, const LayeredBuffer& color,
                               const TraceJob& job, BandRows rows) {
  const AtlasLayout& layout = *job.layout;
  const uint32_t border = job.outside_fill == OutsideFill::kBorder ? abi::kFillBorder : 0;
  abi::GatherPush push{.layers = {},
                       .color = {},
                       .source_size_px = packSize(structure.shape().depth_px),
                       .layer_count = structure.shape().layerCount(),
                       .atlas_width_px = layout.size_px.width,
                       .first_row = rows.first_row,
                       .row_count = rows.row_count,
                       .tile_size_px = packSize(layout.tile_size_px),
                       .tile_grid = packSize({layout.columns, layout.rows}),
                       .padding_top_px = layout.padding_top_px,
                       .fill = redFirst(job.background_rgb) | border,
                       .first_block_row = metBlocks(layout, rows).first_row,
                       .walked_count = layout.lens->walked_count,
                       .gathered_count = layout.lens->gathered_count};
  for (uint32_t i = 0; i < structure.shape().layerCount(); ++i) {
    push.layers[i] = addressWords(structure.structure().address(i));
    push.color[i] = addressWords(color.address(i));
  }
  return push;
}

}  // namespace

const ComputePass& LensGatherer::listPass() {
  std::lock_guard lock(mutex_);
  if (!list_pass_) {
    list_pass_ = std::make_unique<ComputePass>(
        *device_, ComputePassOptions{.spirv = list_met_spirv,
                                     .push_bytes = sizeof(abi::GatherPush),
                                     .descriptors = kListSlots,
                                     .debug_name = "list met surfaces"});
  }
  return *list_pass_;
}

const ComputePass& LensGatherer::gatherPass(const Variant& variant) {
  std::lock_guard lock(mutex_);
  std::unique_ptr<ComputePass>& made = gather_passes_[variant];
  if (!made) {
    const uint32_t constants[] = {variant.reads_by_address, 0,
                                  variant.wanted,           variant.color_format,
                                  variant.color_is_scaled,  variant.is_exact};
    made = std::make_unique<ComputePass>(*device_,
                                         ComputePassOptions{.spirv = gather_lens_spirv,
                                                            .push_bytes = sizeof(abi::GatherPush),
                                                            .specialization = constants,
                                                            .descriptors = kGatherSlots,
                                                            .debug_name = "gather lens"});
  }
  return *made;
}

void LensGatherer::record(vk::CommandBuffer commands, const StructureSlot& structure,
                          const LayeredBuffer& color, uint32_t color_format, const TraceJob& job,
                          BandRows rows, const std::vector<Descriptor>& params,
                          const GatherTarget& target) {
  const AtlasLayout& layout = *job.layout;
  const MetBlocks blocks = metBlocks(layout, rows);
  if (blocks.row_count == 0) return;
  const abi::GatherPush push = describeGather(structure, color, job, rows);
  const Descriptor lists[] = {wholeBuffer(abi::kBindingMet, target.met),
                              wholeBuffer(abi::kBindingMetLists, target.lists)};
  const ComputePass& list = listPass();
  recordComputeBarrier(commands);
  list.recordDescriptors(commands, lists);
  list.record(commands, push, groupCount(blocks.per_row), blocks.row_count);
  recordComputeBarrier(commands);

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
  gather.record(commands, push, groupCount(layout.tile_size_px.width * layout.columns),
                rows.row_count);
  recordComputeBarrier(commands);
}

}  // namespace viewloom
