// SPDX-License-Identifier: Apache-2.0
#include "structure/structure_builder.h"

#include <algorithm>

#include "gpu/barrier.h"
#include "shaders/build_blocks.h"
#include "shaders/build_facets.h"
#include "shaders/build_level.h"
#include "shaders/build_links.h"
#include "shaders/convert_color.h"
#include "shaders/flatten_entries.h"
#include "shaders/linearise_depth.h"
#include "shaders/measure_depth.h"
#include "shaders/settle_tolerance.h"
#include "shaders/sort_columns.h"

namespace viewloom {
namespace {

ComputePass makePass(const Device& device, std::span<const uint32_t> spirv, uint32_t push_bytes,
                     const char* name, std::span<const uint32_t> specialization = {}) {
  return ComputePass(device, {.spirv = spirv,
                              .push_bytes = push_bytes,
                              .specialization = specialization,
                              .debug_name = name});
}

std::vector<ComputePass> makeLinearise(const Device& device) {
  std::vector<ComputePass> passes;
  for (uint32_t type : {abi::kDepthSampleF32, abi::kDepthSampleF16, abi::kDepthSampleU16}) {
    passes.push_back(makePass(device, linearise_depth_spirv, sizeof(abi::LinearisePush),
                              "linearise depth", {&type, 1}));
  }
  return passes;
}

uint32_t groups(uint32_t count, uint32_t group_size) { return (count + group_size - 1) / group_size; }

// Runs one pass between its time stamps.
class Timed {
 public:
  Timed(vk::CommandBuffer commands, GpuTimer* timer, const char* name)
      : commands_(commands), timer_(timer) {
    if (timer_) timer_->recordBegin(commands_, name);
  }
  ~Timed() {
    if (timer_) timer_->recordEnd(commands_);
  }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  vk::CommandBuffer commands_;
  GpuTimer* timer_;
};

// All counters 0, and a minimum that anything is below.
void recordClear(vk::CommandBuffer commands, const Buffer& measured) {
  constexpr uint64_t kMin = offsetof(abi::Measured, inv_z_min_bits);
  commands.fillBuffer(measured.handle(), 0, kMin, 0);
  commands.fillBuffer(measured.handle(), kMin, sizeof(uint32_t), UINT32_MAX);
  commands.fillBuffer(measured.handle(), kMin + sizeof(uint32_t), VK_WHOLE_SIZE, 0);
}

}  // namespace

StructureBuilder::PerLayerCount StructureBuilder::makePerLayerCount(
    const Device& device, std::span<const uint32_t> spirv, const char* name) {
  PerLayerCount passes;
  for (uint32_t layer_count = 1; layer_count <= abi::kLayerCountMax; ++layer_count) {
    passes.push_back(makePass(device, spirv, sizeof(abi::BuildPush), name, {&layer_count, 1}));
  }
  return passes;
}

StructureBuilder::StructureBuilder(const Device& device)
    : convert_color_(
          makePass(device, convert_color_spirv, sizeof(abi::ConvertColorPush), "convert color")),
      linearise_depth_(makeLinearise(device)),
      sort_columns_(makePerLayerCount(device, sort_columns_spirv, "sort columns")),
      measure_depth_(makePass(device, measure_depth_spirv, sizeof(abi::BuildPush), "measure depth")),
      settle_tolerance_(
          makePass(device, settle_tolerance_spirv, sizeof(abi::BuildPush), "settle tolerance")),
      build_facets_(makePerLayerCount(device, build_facets_spirv, "build facets")),
      build_links_(makePerLayerCount(device, build_links_spirv, "build links")),
      build_blocks_(makePass(device, build_blocks_spirv, sizeof(abi::BuildPush), "build blocks")),
      build_level_(makePass(device, build_level_spirv, sizeof(abi::BuildPush), "build level")),
      flatten_entries_(
          makePass(device, flatten_entries_spirv, sizeof(abi::BuildPush), "flatten entries")) {}

void StructureBuilder::record(vk::CommandBuffer commands, const StructureSlot& slot,
                              GpuTimer* timer) const {
  {
    const Timed timed(commands, timer, "color");
    recordClear(commands, slot.measured());
    recordColor(commands, slot);
    recordTransferToCompute(commands);
  }
  const abi::BuildPush& push = slot.buildPush();
  const size_t variant = slot.shape().layerCount() - 1;
  const SizePx size = slot.shape().depth_px;
  const uint32_t groups_x = groups(size.width, abi::kBuildGroupWidth);
  const uint32_t groups_y = groups(size.height, abi::kBuildGroupHeight);
  {
    const Timed timed(commands, timer, "linearise");
    recordLinearise(commands, slot);
  }
  {
    const Timed timed(commands, timer, "measure");
    measure_depth_.record(commands, push, groups(groups(size.width, 4), abi::kBuildGroupWidth),
                          groups(groups(size.height, 4), abi::kBuildGroupHeight));
    recordComputeBarrier(commands);
    settle_tolerance_.record(commands, push, 1);
  }
  {
    const Timed timed(commands, timer, "facets");
    build_facets_[variant].record(commands, push, groups_x, groups_y);
    recordComputeBarrier(commands);
  }
  {
    const Timed timed(commands, timer, "links");
    build_links_[variant].record(commands, push, groups_x, groups_y);
    recordComputeBarrier(commands);
  }
  recordPyramid(commands, slot, timer);
  recordComputeToTransfer(commands);
  commands.copyBuffer(slot.measured().handle(), slot.measuredReadback().handle(),
                      vk::BufferCopy{.size = slot.measuredReadback().sizeBytes()});
  recordTransferToHost(commands);
}

void StructureBuilder::recordLinearise(vk::CommandBuffer commands, const StructureSlot& slot) const {
  const SizePx size = slot.shape().depth_px;
  const uint32_t groups_x = groups(size.width, abi::kBuildGroupWidth);
  const uint32_t groups_y = groups(size.height, abi::kBuildGroupHeight);
  for (const abi::LinearisePush& push : slot.linearisePushes()) {
    linearise_depth_[push.sample_type].record(commands, push, groups_x, groups_y);
  }
  recordComputeBarrier(commands);
  // One layer is sorted as it is.
  const uint32_t layer_count = slot.shape().layerCount();
  if (layer_count == 1) return;
  sort_columns_[layer_count - 1].record(commands, slot.buildPush(), groups_x, groups_y);
  recordComputeBarrier(commands);
}

void StructureBuilder::recordColor(vk::CommandBuffer commands, const StructureSlot& slot) const {
  for (size_t i = 0; i < slot.color().size(); ++i) {
    if (slot.shape().color_storage == ColorStorage::kRgba8Srgb) {
      commands.copyBuffer(slot.staging().handle(), slot.color()[i].handle(),
                          vk::BufferCopy{.srcOffset = slot.staged()[i].color.offset,
                                         .size = slot.staged()[i].color.size_bytes});
      continue;
    }
    // Two dimensions of groups: one alone would pass the least limit of 65535 from 2048 x 2048 px on.
    const uint32_t group_count = groups(slot.conversions()[i].texel_count, abi::kNodeGroupSize);
    const uint32_t groups_x = std::min(group_count, 1024u);
    convert_color_.record(commands, slot.conversions()[i], groups_x, groups(group_count, groups_x));
  }
}

void StructureBuilder::recordPyramid(vk::CommandBuffer commands, const StructureSlot& slot,
                                     GpuTimer* timer) const {
  abi::BuildPush push = slot.buildPush();
  const SizePx size = slot.shape().depth_px;
  const auto record = [&](const ComputePass& pass, uint32_t level) {
    const uint32_t node_px = 1u << level;
    push.level = level;
    pass.record(commands, push, groups(groups(size.width, node_px), abi::kNodeGroupSize),
                groups(size.height, node_px), push.layer_count);
    recordComputeBarrier(commands);
  };
  {
    const Timed timed(commands, timer, "blocks");
    record(build_blocks_, abi::kLevelFirst);
  }
  const Timed timed(commands, timer, "levels");
  for (uint32_t level = abi::kLevelFirst + 1; level <= abi::kLevelLast; ++level) {
    record(build_level_, level);
  }
  record(flatten_entries_, abi::kLevelFirst);
}

}  // namespace viewloom
