// SPDX-License-Identifier: Apache-2.0
#include "structure/structure_builder.h"

#include <algorithm>
#include <span>

#include "gpu/commands.h"
#include "shared/cube_abi.h"
#include "structure/build_recording.h"
#include "structure/structure_variants.h"
#include "structure/timed_stage.h"

namespace viewloom {
namespace {

// All counters 0, and a minimum that anything is below.
void recordClear(Commands commands, const Buffer& measured) {
  constexpr uint64_t kMin = offsetof(abi::MeasuredHead, inv_z_min_bits);
  commands.fill(measured, 0, kMin, 0);
  commands.fill(measured, kMin, sizeof(uint32_t), UINT32_MAX);
  commands.fill(measured, kMin + sizeof(uint32_t), kToTheEnd, 0);
}

// How layers mirror; those that do not, mirror nothing.
void recordSurface(CutRecording& recording, const StructureSlot& slot) {
  const LayeredBuffer* const surface = slot.surface();
  if (surface == nullptr) return;
  for (uint32_t i = 0; i < slot.shape().layerCount(); ++i) {
    const StagedPlane& staged = slot.staged()[i].surface;
    if (staged.size_bytes == 0) {
      recordFill(recording, surface->buffer(i), surface->offsetBytes(i), surface->layerBytes(), 0);
    } else {
      recordCopy(recording, slot.staging(), surface->buffer(i),
                 {.from_offset = staged.offset,
                  .to_offset = surface->offsetBytes(i),
                  .size_bytes = staged.size_bytes});
    }
  }
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
  BuildRecording recording(cuts, slot, passes_.get(variantOf(slot)),
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
  BuildRecording recording(cuts, slot, passes_.get(variantOf(slot)),
                           preparations_.get(preparationOf(slot)));
  recordStage(cuts, timer, "facets", [&] { recording.buildFacets(); });
  recordStage(cuts, timer, "blocks", [&] { recording.buildBlocks(); });
  recordStage(cuts, timer, "levels", [&] { recording.buildLevels(); });
  recording.readBackMeasured();
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
          groupsOf(4 * abi::kCubeApron_px * (side_px + abi::kCubeApron_px), abi::kNodeGroupSize));
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
    const uint32_t group_count = groupsOf(slot.conversions()[i].texel_count, abi::kNodeGroupSize);
    const uint32_t groups_x = std::min(group_count, 1024u);
    const uint32_t row_count = groupsOf(group_count, groups_x);
    for (uint32_t row = 0; row < row_count;) {
      const auto rows = uint32_t(cuts.takeRows(
          BuildPass::kConvert, uint64_t{groups_x} * abi::kNodeGroupSize, row_count - row));
      convert_color_.recordRows(cuts.commands(), slot.conversions()[i], groups_x,
                                {row, row + rows});
      row += rows;
    }
  }
}

}  // namespace viewloom
