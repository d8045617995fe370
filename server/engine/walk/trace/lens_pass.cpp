// SPDX-License-Identifier: Apache-2.0
#include "trace/lens_pass.h"

#include <algorithm>

#include "gpu/commands.h"
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

// Rows of a band, the first of which come first.
struct GatherRows {
  BandRows band;
  uint32_t first_row = 0;  // that is gathered, of the band
};

// Colour is averaged as for rays of the first sample.
ColorReach reachOf(const TraceJob& job) {
  const TileRays rays = raysOf(job, 0, 0);
  return colorReach(rays.tiles, rays.tile_px);
}

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

ComputePass LensPass::makeListPass(const Device& device, const ListVariant& variant) {
  const KernelConstant constants[] = {{abi::kIdReadsByAddress, variant.reads_by_address}};
  return {device,
          {.spirv = list_met_spirv,
           .push_bytes = sizeof(abi::GatherPush),
           .takes_parts = true,
           .constants = constants,
           .descriptors = kListSlots,
           .debug_name = "list met sheets"}};
}

ComputePass LensPass::makeGatherPass(const Device& device, const GatherVariant& variant) {
  const KernelConstant constants[] = {{abi::kIdReadsByAddress, variant.reads_by_address},
                                      {abi::kIdWanted, variant.wanted},
                                      {abi::kIdColorFormat, variant.color_format},
                                      {abi::kIdColorIsScaled, variant.color_is_scaled},
                                      {abi::kIdIsExact, variant.is_exact}};
  return {device,
          {.spirv = gather_lens_spirv,
           .push_bytes = sizeof(abi::GatherPush),
           .takes_parts = true,
           .constants = constants,
           .descriptors = kGatherSlots,
           .debug_name = "gather lens"}};
}

LensPass::GatherVariant LensPass::variantOf(const StructureSlot& structure, const TraceJob& job,
                                            bool wants_linear) {
  return {.reads_by_address = structure.readsByAddress(),
          .wanted = wants_linear ? abi::kWantLinear : 0,
          .color_format = MeanColorPass::formatOf(structure, reachOf(job)),
          .color_is_scaled = structure.shape().colorIsScaled(),
          .is_exact = job.layout->lens->is_exact};
}

void LensPass::addMissing(const StructureSlot& structure, const TraceJob& job, bool wants_linear,
                          MissingKernels& missing) {
  mean_color_.addMissing(structure, reachOf(job), missing);
  list_passes_.addMissing({structure.readsByAddress()}, missing);
  gather_passes_.addMissing(variantOf(structure, job, wants_linear), missing);
}

void LensPass::recordLists(Commands commands, const StructureSlot& structure, const TraceJob& job,
                           BandRows rows, RowSpan span, const TraceSlot& slot, MetRound round) {
  const MetBlocks blocks = metBlocks(*job.layout, rows);
  if (span.first == 0) {
    recordComputeToTransfer(commands);
    commands.fill(slot.incomplete(), 0, sizeof(abi::IncompleteHead), 0);
    recordTransferToCompute(commands);
  }
  const auto rowAt = [&](uint64_t row) {
    return uint32_t(row * blocks.row_count / rows.row_count);
  };
  const GroupRows block_rows{rowAt(span.first), rowAt(span.end)};
  if (block_rows.first == block_rows.end) return;
  const ComputePass& list = list_passes_.get({structure.readsByAddress()});
  const Descriptor descriptors[] = {structure.structure().asTexels(abi::kBindingStructure),
                                    slot.params().of(job, 0, 0).front(),
                                    wholeBuffer(abi::kBindingMet, slot.met()),
                                    wholeBuffer(abi::kBindingMetLists, slot.metLists()),
                                    wholeBuffer(abi::kBindingIncomplete, slot.incomplete())};
  list.recordDescriptors(commands, descriptors);
  list.recordRows(commands, describeGather(structure, nullptr, job, {rows, 0}, round),
                  groupCount(blocks.per_row), block_rows);
  recordComputeBarrier(commands);
}

void LensPass::record(Commands commands, const StructureSlot& structure, const TraceJob& job,
                      BandRows rows, const BandPart& part, const TraceSlot& slot) {
  const AtlasLayout& layout = *job.layout;
  const ComputePass& gather =
      gather_passes_.get(variantOf(structure, job, slot.linearAddress() != 0));
  const MeanColorPass::Color color = mean_color_.record(commands, structure, reachOf(job));
  // Beside the views is nothing.
  GroupColumns columns = groupsOf(part);
  columns.end = std::min(columns.end, groupCount(layout.tile_size_px.width * layout.columns));
  if (metBlocks(layout, rows).row_count == 0 || columns.first >= columns.end) return;
  std::vector<Descriptor> descriptors = slot.params().of(job, 0, 0);
  for (const Descriptor& descriptor :
       {slot.params().lensPoints(job, 0), structure.measuredDescriptor(),
        structure.structure().asTexels(abi::kBindingStructure),
        structure.structure().asHalfTexels(abi::kBindingStructureHalves),
        color.texels.asTexels(abi::kBindingColor), wholeBuffer(abi::kBindingBand, slot.rgba()),
        wholeBuffer(abi::kBindingMetLists, slot.metLists()),
        wholeBuffer(abi::kBindingSums, slot.sums())}) {
    descriptors.push_back(descriptor);
  }
  gather.recordDescriptors(commands, descriptors);
  gather.recordColumns(commands,
                       describeGather(structure, &color.texels, job, {rows, part.first_row}, {}),
                       columns, part.end_row - part.first_row);
  recordComputeBarrier(commands);
}

}  // namespace viewloom
