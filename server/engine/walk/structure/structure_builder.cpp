// SPDX-License-Identifier: Apache-2.0
#include "structure/structure_builder.h"

#include <algorithm>
#include <span>

#include "gpu/commands.h"
#include "shared/cube_abi.h"
#include "structure/structure_variants.h"
#include "structure/timed_stage.h"

namespace viewloom {
namespace {

uint32_t groups(uint32_t count, uint32_t group_size) {
  return (count + group_size - 1) / group_size;
}

// All counters 0, and a minimum that anything is below.
void recordClear(Commands commands, const Buffer& measured) {
  constexpr uint64_t kMin = offsetof(abi::MeasuredHead, inv_z_min_bits);
  commands.fill(measured, 0, kMin, 0);
  commands.fill(measured, kMin, sizeof(uint32_t), UINT32_MAX);
  commands.fill(measured, kMin + sizeof(uint32_t), kToTheEnd, 0);
}

std::vector<Descriptor> describeBindings(const StructureSlot& slot) {
  return {slot.measuredDescriptor(),
          slot.structure().asTexels(abi::kBindingStructure),
          slot.structure().asHalfTexels(abi::kBindingStructureHalves),
          slot.invZ().asTexels(abi::kBindingInvZ),
          slot.invZ().asStorage(abi::kBindingInvZOut),
          slot.structure().asStorage(abi::kBindingStructureOut),
          slot.depthPlanesDescriptor(),
          slot.stagingDescriptor()};
}

// How layers mirror; those that do not, mirror nothing.
void recordSurface(CutRecording& recording, const StructureSlot& slot) {
  const LayeredBuffer* const surface = slot.surface();
  if (surface == nullptr) return;
  for (uint32_t i = 0; i < slot.shape().layerCount(); ++i) {
    const StagedPlane& staged = slot.staged()[i].surface;
    if (staged.size_bytes == 0) {
      recording.commands().fill(surface->buffer(i), surface->offsetBytes(i), surface->layerBytes(),
                                0);
    } else {
      recordCopy(recording, slot.staging(), surface->buffer(i),
                 {.from_offset = staged.offset,
                  .to_offset = surface->offsetBytes(i),
                  .size_bytes = staged.size_bytes});
    }
  }
}

// One build, stage after stage.
class Recording {
 public:
  Recording(CutRecording& recording, const StructureSlot& slot, const StructurePasses& passes,
            const ComputePass& preparation)
      : recording_(recording),
        slot_(slot),
        passes_(passes),
        preparation_(preparation),
        bindings_(describeBindings(slot)) {}

  void prepare();
  void measure();
  void smooth();
  void buildFacets() { overNodes(passes_.build_facets, abi::kLevelFirst, 1); }
  void buildBlocks() { overNodes(passes_.build_blocks, abi::kLevelFirst, 1); }
  void buildLevels();

 private:
  // Groups of a pass. A row of them takes so many rows of px.
  struct Groups {
    uint32_t x = 1;
    uint32_t y = 1;
    uint32_t z = 1;
    uint32_t row_px = 1;
  };
  // Dispatches, with what the slot binds, and lets later passes see the result.
  void dispatch(const ComputePass& pass, abi::BuildPush push, const Groups& groups);
  // An invocation a node; kernels that take whole columns dispatch one layer.
  void overNodes(const ComputePass& pass, uint32_t level, uint32_t layer_count);

  CutRecording& recording_;
  const StructureSlot& slot_;
  const StructurePasses& passes_;
  const ComputePass& preparation_;
  std::vector<Descriptor> bindings_;
};

void Recording::dispatch(const ComputePass& pass, abi::BuildPush push, const Groups& groups) {
  const FrameShape& shape = slot_.shape();
  const uint64_t row_px_count = uint64_t{shape.depth_px.width} * groups.row_px * shape.layerCount();
  const auto rows_max =
      uint32_t(std::clamp<uint64_t>(recording_.piecePxCount() / row_px_count, 1, groups.y));
  while (push.first_group_row < groups.y) {
    const uint32_t rows = std::min(rows_max, groups.y - push.first_group_row);
    const Commands commands = recording_.commands();
    pass.recordDescriptors(commands, bindings_);
    pass.record(commands, push, groups.x, rows, groups.z);
    recordComputeBarrier(commands);
    recording_.note(rows * row_px_count);
    push.first_group_row += rows;
  }
}

void Recording::overNodes(const ComputePass& pass, uint32_t level, uint32_t layer_count) {
  const SizePx size = slot_.shape().depth_px;
  const uint32_t node_px = 1u << level;
  abi::BuildPush push = slot_.buildPush();
  push.level = level;
  dispatch(pass, push,
           {.x = groups(groups(size.width, node_px), abi::kNodeGroupSize),
            .y = groups(size.height, node_px),
            .z = layer_count,
            .row_px = node_px});
}

// Also the guard around the image.
void Recording::prepare() {
  const SizePx size = slot_.shape().depth_px;
  const uint32_t blocks_x = abi::invZPitch(size.width) / abi::kBlockPx;
  dispatch(preparation_, slot_.buildPush(),
           {.x = groups(blocks_x, abi::kNodeGroupSize),
            .y = groups(size.height, abi::kBlockPx) + 2,
            .row_px = abi::kBlockPx});
}

void Recording::measure() {
  const SizePx size = slot_.shape().depth_px;
  constexpr uint32_t kStripPx = abi::kMeasuredBlocks * abi::kBlockPx;
  const auto overStrips = [&](const ComputePass& pass) {
    dispatch(pass, slot_.buildPush(),
             {.x = groups(groups(size.width, kStripPx), abi::kNodeGroupSize),
              .y = groups(size.height, abi::kBlockPx),
              .row_px = abi::kBlockPx});
  };
  overStrips(passes_.measure_depth);
  dispatch(passes_.settle_range, slot_.buildPush(), {});
  overStrips(passes_.measure_range);
  dispatch(passes_.settle_tolerance, slot_.buildPush(), {});
}

// The device has settled whether there is anything to do, and for which passes.
void Recording::smooth() {
  abi::BuildPush push = slot_.buildPush();
  for (uint32_t pass = 0; pass < abi::kSmoothingPassCount; ++pass) {
    push.level = pass;
    const Commands commands = recording_.commands();
    passes_.smooth_columns.recordDescriptors(commands, bindings_);
    passes_.smooth_columns.recordIndirect(commands, push, slot_.measured(),
                                          pass < abi::kFirstShortPass
                                              ? offsetof(abi::MeasuredHead, long_groups)
                                              : offsetof(abi::MeasuredHead, short_groups));
    recordComputeBarrier(commands);
    recording_.note(slot_.shape().depth_px.area() * slot_.shape().layerCount());
  }
}

void Recording::buildLevels() {
  const uint32_t layer_count = slot_.shape().layerCount();
  for (uint32_t level = abi::kLevelFirst + 1; level <= abi::kLevelLast; ++level) {
    overNodes(passes_.build_level, level, layer_count);
  }
  overNodes(passes_.flatten_entries, abi::kLevelFirst, layer_count);
}

}  // namespace

StructureBuilder::StructureBuilder(const Device& device)
    : device_(device),
      convert_color_(makeConvertColor(device)),
      passes_(device, makeStructurePasses),
      preparations_(device, makePrepareColumns),
      apron_passes_(device, makeApronPasses) {}

void StructureBuilder::addMissing(const PrepareVariant& variant, MissingKernels& missing) const {
  passes_.addMissing(variant.structure, missing);
  preparations_.addMissing(variant, missing);
}

void StructureBuilder::addMissing(const Frame& frame, MissingKernels& missing) const {
  for (const SourcePart& part : partsOf(frame.format)) {
    addMissing(preparationOf(device_, frame, part), missing);
    if (part.face) apron_passes_.addMissing({}, missing);
  }
}

std::vector<MissingKernels> StructureBuilder::likelyKernels() const {
  std::vector<MissingKernels> kernels;
  for (const PrepareVariant& variant : likelyPreparations()) {
    addMissing(variant, kernels.emplace_back());
  }
  return kernels;
}

void StructureBuilder::recordColumns(CutRecording& cuts, const StructureSlot& slot,
                                     GpuTimer* timer) const {
  Recording recording(cuts, slot, passes_.get(variantOf(slot)),
                      preparations_.get(preparationOf(slot)));
  recordStage(cuts, timer, "color", [&] {
    recordClear(cuts.commands(), slot.measured());
    recordColor(cuts, slot);
    recordSurface(cuts, slot);
    recordTransferToCompute(cuts.commands());
  });
  recordStage(cuts, timer, "columns", [&] { recording.prepare(); });
  recordStage(cuts, timer, "measure", [&] { recording.measure(); });
  recordStage(cuts, timer, "smooth", [&] { recording.smooth(); });
}

void StructureBuilder::recordSurfaces(CutRecording& cuts, const StructureSlot& slot,
                                      GpuTimer* timer) const {
  Recording recording(cuts, slot, passes_.get(variantOf(slot)),
                      preparations_.get(preparationOf(slot)));
  recordStage(cuts, timer, "facets", [&] { recording.buildFacets(); });
  recordStage(cuts, timer, "blocks", [&] { recording.buildBlocks(); });
  recordStage(cuts, timer, "levels", [&] { recording.buildLevels(); });
  const Commands commands = cuts.commands();
  recordComputeToTransfer(commands);
  commands.copy(slot.measured(), slot.measuredReadback(),
                {.size_bytes = slot.measuredReadback().sizeBytes()});
  recordTransferToHost(commands);
}

void StructureBuilder::record(Commands commands, const StructureSlot& slot, GpuTimer* timer) const {
  CutRecording uncut(commands);
  recordColumns(uncut, slot, timer);
  recordSurfaces(uncut, slot, timer);
}

void StructureBuilder::record(CutRecording& cuts, const StructureSlot& slot) const {
  recordColumns(cuts, slot, nullptr);
  recordSurfaces(cuts, slot, nullptr);
}

void StructureBuilder::recordCube(CutRecording& cuts, std::span<const StructureSlot* const> faces,
                                  const Buffer& face_list) const {
  const ApronPasses& passes = apron_passes_.get({});
  const auto recordAprons = [&](const ComputePass& pass) {
    for (uint32_t face = 0; face < faces.size(); ++face) {
      const StructureSlot& slot = *faces[face];
      const uint32_t side_px = slot.shape().depth_px.width - 2 * abi::kCubeApron_px;
      const abi::ApronPush push{.cube = addressWords(face_list.address()),
                                .face = face,
                                .color_format = colorFormat(slot.shape().color_storage)};
      pass.recordDescriptors(cuts.commands(), describeBindings(slot));
      pass.record(
          cuts.commands(), push,
          groups(4 * abi::kCubeApron_px * (side_px + abi::kCubeApron_px), abi::kNodeGroupSize));
    }
    recordComputeBarrier(cuts.commands());
  };
  for (const StructureSlot* face : faces) recordColumns(cuts, *face, nullptr);
  recordAprons(passes.fill_apron);
  for (const StructureSlot* face : faces) recordSurfaces(cuts, *face, nullptr);
  recordAprons(passes.color_apron);
}

void StructureBuilder::recordColor(CutRecording& cuts, const StructureSlot& slot) const {
  if (slot.colorIsInPlace()) return;
  for (uint32_t i = 0; i < slot.shape().layerCount(); ++i) {
    if (slot.shape().color_storage == ColorStorage::kRgba8Srgb) {
      recordCopy(cuts, slot.staging(), slot.color().buffer(i),
                 {.from_offset = slot.staged()[i].color.offset,
                  .to_offset = slot.color().offsetBytes(i),
                  .size_bytes = slot.staged()[i].color.size_bytes});
      continue;
    }
    // Two dimensions of groups: one alone would pass the least limit of 65535 from 2048 x 2048 px
    // on.
    const uint32_t group_count = groups(slot.conversions()[i].texel_count, abi::kNodeGroupSize);
    const uint32_t groups_x = std::min(group_count, 1024u);
    convert_color_.record(cuts.commands(), slot.conversions()[i], groups_x,
                          groups(group_count, groups_x));
    cuts.note(slot.conversions()[i].texel_count);
  }
}

}  // namespace viewloom
