// SPDX-License-Identifier: Apache-2.0
#include "structure/structure_builder.h"

#include <algorithm>

#include "gpu/barrier.h"

namespace viewloom {
namespace {

uint32_t groups(uint32_t count, uint32_t group_size) {
  return (count + group_size - 1) / group_size;
}

// Runs one stage between its time stamps.
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
  constexpr uint64_t kMin = offsetof(abi::MeasuredHead, inv_z_min_bits);
  commands.fillBuffer(measured.handle(), 0, kMin, 0);
  commands.fillBuffer(measured.handle(), kMin, sizeof(uint32_t), UINT32_MAX);
  commands.fillBuffer(measured.handle(), kMin + sizeof(uint32_t), VK_WHOLE_SIZE, 0);
}

std::vector<Descriptor> describeBindings(const StructureSlot& slot) {
  return {slot.measuredDescriptor(),
          slot.structure().asTexels(abi::kBindingStructure),
          slot.invZ().asTexels(abi::kBindingInvZ),
          slot.invZ().asStorage(abi::kBindingInvZOut),
          slot.structure().asStorage(abi::kBindingStructureOut),
          slot.structure().asStorage(abi::kBindingLinksOut)};
}

// One build, stage after stage.
class Recording {
 public:
  Recording(vk::CommandBuffer commands, const StructureSlot& slot, const StructurePasses& passes)
      : commands_(commands), slot_(slot), passes_(passes), bindings_(describeBindings(slot)) {}

  void linearise();
  void measure();
  void buildFacets() { overPixels(passes_.build_facets); }
  void buildLinks() { overPixels(passes_.build_links); }
  void buildBlocks() { overNodes(passes_.build_blocks, abi::kLevelFirst); }
  void buildLevels();

 private:
  // Dispatches, with what the slot binds, and lets later passes see the result.
  void dispatch(const ComputePass& pass, const abi::BuildPush& push, uint32_t groups_x,
                uint32_t groups_y, uint32_t groups_z);
  void overPixels(const ComputePass& pass);
  void overNodes(const ComputePass& pass, uint32_t level);
  SizePx pixelGroups(uint32_t px_per_invocation) const;

  vk::CommandBuffer commands_;
  const StructureSlot& slot_;
  const StructurePasses& passes_;
  std::vector<Descriptor> bindings_;
};

SizePx Recording::pixelGroups(uint32_t px_per_invocation) const {
  const SizePx size = slot_.shape().depth_px;
  return {groups(groups(size.width, px_per_invocation), abi::kBuildGroupWidth),
          groups(groups(size.height, px_per_invocation), abi::kBuildGroupHeight)};
}

void Recording::dispatch(const ComputePass& pass, const abi::BuildPush& push, uint32_t groups_x,
                         uint32_t groups_y, uint32_t groups_z) {
  pass.recordDescriptors(commands_, bindings_);
  pass.record(commands_, push, groups_x, groups_y, groups_z);
  recordComputeBarrier(commands_);
}

void Recording::overPixels(const ComputePass& pass) {
  const SizePx group_count = pixelGroups(1);
  dispatch(pass, slot_.buildPush(), group_count.width, group_count.height, 1);
}

void Recording::overNodes(const ComputePass& pass, uint32_t level) {
  const SizePx size = slot_.shape().depth_px;
  const uint32_t node_px = 1u << level;
  abi::BuildPush push = slot_.buildPush();
  push.level = level;
  dispatch(pass, push, groups(groups(size.width, node_px), abi::kNodeGroupSize),
           groups(size.height, node_px), push.layer_count);
}

void Recording::linearise() {
  const SizePx group_count = pixelGroups(1);
  for (const abi::LinearisePush& push : slot_.linearisePushes()) {
    const ComputePass& pass = passes_.linearise_depth[push.sample_type];
    std::vector<Descriptor> bindings = bindings_;
    const StagedPlane& depth = slot_.staged()[push.layer].depth;
    // Samples reached by address may be more than a binding holds: then one stands for them.
    bindings.push_back({.binding = abi::kBindingSamples,
                        .kind = DescriptorKind::kStorage,
                        .buffer = slot_.staging().handle(),
                        .offset_bytes = depth.offset,
                        .size_bytes = slot_.readsByAddress() ? sizeof(float) : depth.size_bytes});
    pass.recordDescriptors(commands_, bindings);
    pass.record(commands_, push, group_count.width, group_count.height);
  }
  recordComputeBarrier(commands_);
  // One layer is sorted as it is.
  if (slot_.shape().layerCount() > 1) overPixels(passes_.sort_columns);
}

void Recording::measure() {
  const SizePx group_count = pixelGroups(4);
  dispatch(passes_.measure_depth, slot_.buildPush(), group_count.width, group_count.height, 1);
  dispatch(passes_.settle_tolerance, slot_.buildPush(), 1, 1, 1);
}

void Recording::buildLevels() {
  for (uint32_t level = abi::kLevelFirst + 1; level <= abi::kLevelLast; ++level) {
    overNodes(passes_.build_level, level);
  }
  overNodes(passes_.flatten_entries, abi::kLevelFirst);
}

}  // namespace

StructureBuilder::StructureBuilder(const Device& device)
    : device_(&device), convert_color_(makeConvertColor(device)) {}

const StructurePasses& StructureBuilder::passesFor(const StructureSlot& slot) const {
  const StructureVariant variant{.reads_by_address = slot.readsByAddress(),
                                 .writes_by_address = slot.writesByAddress(),
                                 .layer_count = slot.shape().layerCount()};
  std::lock_guard lock(mutex_);
  std::unique_ptr<StructurePasses>& passes = passes_[variant];
  if (!passes) passes = std::make_unique<StructurePasses>(*device_, variant);
  return *passes;
}

void StructureBuilder::record(vk::CommandBuffer commands, const StructureSlot& slot,
                              GpuTimer* timer) const {
  Recording recording(commands, slot, passesFor(slot));
  const auto stage = [&](const char* name, auto&& record) {
    const Timed timed(commands, timer, name);
    record();
  };
  stage("color", [&] {
    recordClear(commands, slot.measured());
    recordColor(commands, slot);
    recordTransferToCompute(commands);
  });
  stage("linearise", [&] { recording.linearise(); });
  stage("measure", [&] { recording.measure(); });
  stage("facets", [&] { recording.buildFacets(); });
  stage("links", [&] { recording.buildLinks(); });
  stage("blocks", [&] { recording.buildBlocks(); });
  stage("levels", [&] { recording.buildLevels(); });
  recordComputeToTransfer(commands);
  commands.copyBuffer(slot.measured().handle(), slot.measuredReadback().handle(),
                      vk::BufferCopy{.size = slot.measuredReadback().sizeBytes()});
  recordTransferToHost(commands);
}

void StructureBuilder::recordColor(vk::CommandBuffer commands, const StructureSlot& slot) const {
  for (uint32_t i = 0; i < slot.shape().layerCount(); ++i) {
    if (slot.shape().color_storage == ColorStorage::kRgba8Srgb) {
      commands.copyBuffer(slot.staging().handle(), slot.color().buffer(i).handle(),
                          vk::BufferCopy{.srcOffset = slot.staged()[i].color.offset,
                                         .dstOffset = slot.color().offsetBytes(i),
                                         .size = slot.staged()[i].color.size_bytes});
      continue;
    }
    // Two dimensions of groups: one alone would pass the least limit of 65535 from 2048 x 2048 px
    // on.
    const uint32_t group_count = groups(slot.conversions()[i].texel_count, abi::kNodeGroupSize);
    const uint32_t groups_x = std::min(group_count, 1024u);
    convert_color_.record(commands, slot.conversions()[i], groups_x, groups(group_count, groups_x));
  }
}

}  // namespace viewloom
