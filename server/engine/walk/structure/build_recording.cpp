// SPDX-License-Identifier: Apache-2.0
#include "structure/build_recording.h"

#include <cstddef>

#include "gpu/commands.h"
#include "shared/structure_abi.h"

namespace viewloom {

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

void BuildRecording::dispatch(BuildPass kind, const ComputePass& pass, abi::BuildPush push,
                              const Groups& groups) {
  while (push.first_group_row < groups.y) {
    const auto rows =
        uint32_t(recording_.takeRows(kind, groups.row_px_count, groups.y - push.first_group_row));
    const Commands commands = recording_.commands();
    pass.recordDescriptors(commands, bindings_);
    pass.record(commands, push, groups.x, rows, groups.z);
    recordComputeBarrier(commands);
    push.first_group_row += rows;
  }
}

void BuildRecording::overNodes(BuildPass kind, const ComputePass& pass, uint32_t level,
                               uint32_t layer_count, uint64_t row_px_count) {
  const SizePx size = slot_.shape().depth_px;
  const uint32_t node_px = 1u << level;
  abi::BuildPush push = slot_.buildPush();
  push.level = level;
  dispatch(kind, pass, push,
           {.x = groupsOf(groupsOf(size.width, node_px), abi::kNodeGroupSize),
            .y = groupsOf(size.height, node_px),
            .z = layer_count,
            .row_px_count = row_px_count});
}

void BuildRecording::overBlocks(BuildPass kind, const ComputePass& pass, uint32_t layer_count) {
  overNodes(kind, pass, abi::kLevelFirst, layer_count, pxOfRows(1u << abi::kLevelFirst));
}

void BuildRecording::prepare() {
  const SizePx size = slot_.shape().depth_px;
  const uint32_t blocks_x = abi::invZPitch(size.width) / abi::kBlockPx;
  dispatch(BuildPass::kPrepare, preparation_, slot_.buildPush(),
           {.x = groupsOf(blocks_x, abi::kNodeGroupSize),
            .y = groupsOf(size.height, abi::kBlockPx) + 2,
            .row_px_count = pxOfRows(abi::kBlockPx)});
}

void BuildRecording::measure() {
  const SizePx size = slot_.shape().depth_px;
  constexpr uint32_t kStripPx = abi::kMeasuredBlocks * abi::kBlockPx;
  const auto overStrips = [&](const ComputePass& pass) {
    dispatch(BuildPass::kMeasure, pass, slot_.buildPush(),
             {.x = groupsOf(groupsOf(size.width, kStripPx), abi::kNodeGroupSize),
              .y = groupsOf(size.height, abi::kBlockPx),
              .row_px_count = pxOfRows(abi::kBlockPx)});
  };
  overStrips(passes_.measure_depth);
  dispatch(BuildPass::kMeasure, passes_.settle_range, slot_.buildPush(), {});
  overStrips(passes_.measure_range);
  dispatch(BuildPass::kMeasure, passes_.settle_tolerance, slot_.buildPush(), {});
}

void BuildRecording::smooth() {
  // A smoothed px takes about as long as so many that are measured.
  constexpr uint64_t kMeasuredPerSmoothed = 4;
  const uint64_t px_count = pxOfRows(slot_.shape().depth_px.height) * abi::kSmoothingPassCount;
  if (recording_.isLong(BuildPass::kMeasure, px_count * kMeasuredPerSmoothed)) {
    smoothInPieces();
  } else {
    smoothUnseen();
  }
}

void BuildRecording::smoothUnseen() {
  abi::BuildPush push = slot_.buildPush();
  const Commands commands = recording_.commands();
  for (uint32_t pass = 0; pass < abi::kSmoothingPassCount; ++pass) {
    push.level = pass;
    passes_.smooth_columns.recordDescriptors(commands, bindings_);
    passes_.smooth_columns.recordIndirect(commands, push, slot_.measured(),
                                          pass < abi::kFirstShortPass
                                              ? offsetof(abi::MeasuredHead, long_groups)
                                              : offsetof(abi::MeasuredHead, short_groups));
    recordComputeBarrier(commands);
  }
}

void BuildRecording::smoothInPieces() {
  readBackMeasured();
  recording_.cut();
  const abi::MeasuredHead head = slot_.measuredHead();
  abi::BuildPush push = slot_.buildPush();
  for (uint32_t pass = 0; pass < abi::kSmoothingPassCount; ++pass) {
    const abi::uvec3 groups = pass < abi::kFirstShortPass ? head.long_groups : head.short_groups;
    if (groups.x == 0) continue;
    push.level = pass;
    for (uint32_t row = 0; row < groups.y;) {
      const auto rows = uint32_t(
          recording_.takeRows(BuildPass::kSmooth, pxOfRows(abi::kBlockPx), groups.y - row));
      const Commands commands = recording_.commands();
      passes_.smooth_columns.recordDescriptors(commands, bindings_);
      passes_.smooth_columns.recordRows(commands, push, groups.x, {row, row + rows});
      recordComputeBarrier(commands);
      row += rows;
    }
  }
}

void BuildRecording::buildLevels() {
  const uint32_t layer_count = slot_.shape().layerCount();
  for (uint32_t level = abi::kLevelFirst + 1; level <= abi::kLevelLast; ++level) {
    const uint64_t row_nodes =
        uint64_t{groupsOf(slot_.shape().depth_px.width, 1u << level)} * layer_count;
    overNodes(BuildPass::kLevels, passes_.build_level, level, layer_count, row_nodes);
  }
  overBlocks(BuildPass::kFlatten, passes_.flatten_entries, layer_count);
}

void BuildRecording::readBackMeasured() {
  const Commands commands = recording_.commands();
  recordComputeToTransfer(commands);
  commands.copy(slot_.measured(), slot_.measuredReadback(),
                {.size_bytes = slot_.measuredReadback().sizeBytes()});
  recordTransferToHost(commands);
}

}  // namespace viewloom
