// SPDX-License-Identifier: Apache-2.0
#include "gpu/compute_pass.h"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "base/check.h"
#include "gpu/vulkan.h"
#include "shared/kernel_constants.h"

namespace viewloom {
namespace {

vk::DescriptorType typeOf(DescriptorKind kind) {
  switch (kind) {
    case DescriptorKind::kTexels:
      return vk::DescriptorType::eUniformTexelBuffer;
    case DescriptorKind::kUniform:
      return vk::DescriptorType::eUniformBuffer;
    case DescriptorKind::kStorage:
      break;
  }
  return vk::DescriptorType::eStorageBuffer;
}

bool isOfMemory(uint32_t id) {
  return id == abi::kIdReadsByAddress || id == abi::kIdWritesByAddress;
}

vk::raii::DescriptorSetLayout makeSlots(const Device& device,
                                        std::span<const DescriptorSlot> descriptors) {
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  for (const DescriptorSlot& slot : descriptors) {
    bindings.push_back({.binding = slot.binding,
                        .descriptorType = typeOf(slot.kind),
                        .descriptorCount = 1,
                        .stageFlags = vk::ShaderStageFlagBits::eCompute});
  }
  return {device.handle(),
          {.flags = vk::DescriptorSetLayoutCreateFlagBits::ePushDescriptorKHR,
           .bindingCount = static_cast<uint32_t>(bindings.size()),
           .pBindings = bindings.data()}};
}

vk::raii::PipelineLayout makeLayout(const Device& device, uint32_t push_bytes,
                                    vk::DescriptorSetLayout slots) {
  VIEWLOOM_CHECK(push_bytes <= device.info().limits.push_bytes_max);
  const vk::PushConstantRange range{.stageFlags = vk::ShaderStageFlagBits::eCompute,
                                    .size = push_bytes};
  return {device.handle(),
          {.setLayoutCount = 1,
           .pSetLayouts = &slots,
           .pushConstantRangeCount = push_bytes > 0 ? 1u : 0u,
           .pPushConstantRanges = &range}};
}

// The constant_id of all constants of a kernel: each is decorated in its SPIR-V.
std::set<uint32_t> constantsOf(std::span<const uint32_t> spirv) {
  constexpr size_t kHeaderWords = 5;
  constexpr uint32_t kOpDecorate = 71, kSpecId = 1;
  std::set<uint32_t> ids;
  for (size_t at = kHeaderWords; at < spirv.size();) {
    const uint32_t word_count = spirv[at] >> 16;
    const uint32_t opcode = spirv[at] & 0xffff;
    VIEWLOOM_CHECK(word_count > 0 && at + word_count <= spirv.size());
    if (opcode == kOpDecorate && word_count == 4 && spirv[at + 2] == kSpecId) {
      ids.insert(spirv[at + 3]);
    }
    at += word_count;
  }
  return ids;
}

// A kernel that is given a constant of another one, or lacks one of its own, would answer wrongly.
void checkConstants(const ComputePassOptions& options) {
  std::set<uint32_t> left = constantsOf(options.spirv);
  left.erase(kFaultConstantId);
  for (const KernelConstant& constant : options.constants) {
    const bool is_known = left.erase(constant.id) == 1;
    VIEWLOOM_CHECK(is_known || isOfMemory(constant.id));
  }
  VIEWLOOM_CHECK(std::ranges::all_of(left, isOfMemory));
}

vk::raii::Pipeline makePipeline(const Device& device, const ComputePassOptions& options,
                                vk::PipelineLayout layout) {
  const vk::raii::ShaderModule module(
      device.handle(), {.codeSize = options.spirv.size_bytes(), .pCode = options.spirv.data()});
  std::vector<vk::SpecializationMapEntry> entries;
  std::vector<uint32_t> values;
  const auto specialise = [&](uint32_t id, uint32_t value) {
    entries.push_back({.constantID = id,
                       .offset = static_cast<uint32_t>(values.size() * sizeof(uint32_t)),
                       .size = sizeof(uint32_t)});
    values.push_back(value);
  };
  checkConstants(options);
  for (const KernelConstant& constant : options.constants) specialise(constant.id, constant.value);
  if (device.plantedFault() != 0) specialise(kFaultConstantId, device.plantedFault());
  const vk::SpecializationInfo specialization{
      .mapEntryCount = static_cast<uint32_t>(entries.size()),
      .pMapEntries = entries.data(),
      .dataSize = values.size() * sizeof(uint32_t),
      .pData = values.data()};
  const vk::PipelineShaderStageCreateInfo stage{.stage = vk::ShaderStageFlagBits::eCompute,
                                                .module = *module,
                                                .pName = "main",
                                                .pSpecializationInfo = &specialization};
  return {device.handle(), device.pipelineCache(),
          vk::ComputePipelineCreateInfo{.flags = options.takes_parts
                                                     ? vk::PipelineCreateFlagBits::eDispatchBase
                                                     : vk::PipelineCreateFlags(),
                                        .stage = stage,
                                        .layout = layout}};
}

}  // namespace

ComputePass::ComputePass(const Device& device, const ComputePassOptions& options)
    : device_(&device),
      push_bytes_(options.push_bytes),
      takes_parts_(options.takes_parts),
      slots_(hide(makeSlots(device, options.descriptors))),
      layout_(hide(makeLayout(device, options.push_bytes, **slots_))),
      pipeline_(hide(makePipeline(device, options, **layout_))) {
  const auto raw_handle = reinterpret_cast<uint64_t>(static_cast<VkPipeline>(**pipeline_));
  device.setName(vk::ObjectType::ePipeline, raw_handle, options.debug_name);
  device.noteKernel();
}

void ComputePass::recordDescriptors(Commands commands,
                                    std::span<const Descriptor> descriptors) const {
  constexpr size_t kCountMax = 16;
  VIEWLOOM_CHECK(descriptors.size() <= kCountMax);
  std::array<vk::DescriptorBufferInfo, kCountMax> buffers;
  std::array<vk::BufferView, kCountMax> views;
  std::array<vk::WriteDescriptorSet, kCountMax> writes;
  for (size_t i = 0; i < descriptors.size(); ++i) {
    const Descriptor& descriptor = descriptors[i];
    const bool is_texels = descriptor.kind == DescriptorKind::kTexels;
    if (is_texels) views[i] = descriptor.texels->handle();
    buffers[i] =
        vk::DescriptorBufferInfo{.buffer = is_texels ? vk::Buffer() : descriptor.buffer->handle(),
                                 .offset = descriptor.offset_bytes,
                                 .range = descriptor.size_bytes};
    writes[i] = vk::WriteDescriptorSet{.dstBinding = descriptor.binding,
                                       .descriptorCount = 1,
                                       .descriptorType = typeOf(descriptor.kind),
                                       .pBufferInfo = is_texels ? nullptr : &buffers[i],
                                       .pTexelBufferView = is_texels ? &views[i] : nullptr};
  }
  vk::CommandBuffer(commands.handle())
      .pushDescriptorSetKHR(vk::PipelineBindPoint::eCompute, **layout_, 0,
                            static_cast<uint32_t>(descriptors.size()), writes.data(),
                            *device_->handle().getDispatcher());
}

void ComputePass::recordState(Commands commands, std::span<const std::byte> push) const {
  VIEWLOOM_CHECK(push.size() == push_bytes_);
  const vk::CommandBuffer recording(commands.handle());
  recording.bindPipeline(vk::PipelineBindPoint::eCompute, **pipeline_);
  if (!push.empty()) {
    recording.pushConstants(**layout_, vk::ShaderStageFlagBits::eCompute, 0,
                            static_cast<uint32_t>(push.size()), push.data());
  }
}

void ComputePass::record(Commands commands, std::span<const std::byte> push, uint32_t groups_x,
                         uint32_t groups_y, uint32_t groups_z) const {
  recordState(commands, push);
  vk::CommandBuffer(commands.handle()).dispatch(groups_x, groups_y, groups_z);
}

void ComputePass::recordColumns(Commands commands, std::span<const std::byte> push,
                                GroupColumns columns, uint32_t groups_y) const {
  VIEWLOOM_CHECK(takes_parts_ && columns.first < columns.end);
  recordState(commands, push);
  vk::CommandBuffer(commands.handle())
      .dispatchBase(columns.first, 0, 0, columns.end - columns.first, groups_y, 1);
}

void ComputePass::recordRows(Commands commands, std::span<const std::byte> push, uint32_t groups_x,
                             GroupRows rows) const {
  VIEWLOOM_CHECK(takes_parts_ && rows.first < rows.end);
  recordState(commands, push);
  vk::CommandBuffer(commands.handle())
      .dispatchBase(0, rows.first, 0, groups_x, rows.end - rows.first, 1);
}

void ComputePass::recordIndirect(Commands commands, std::span<const std::byte> push,
                                 const Buffer& groups, uint64_t offset_bytes) const {
  recordState(commands, push);
  if (device_->info().is_software) {
    // lavapipe (Mesa 22.3) would begin with the group that the dispatch before it began with. This
    // one without groups uses no memory, but the validation layers count it as a use.
    vk::CommandBuffer(commands.handle()).dispatch(0, 1, 1);
    recordComputeBarrier(commands);
  }
  vk::CommandBuffer(commands.handle()).dispatchIndirect(groups.handle(), offset_bytes);
}

}  // namespace viewloom
