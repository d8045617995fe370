// SPDX-License-Identifier: Apache-2.0
#include "gpu/compute_pass.h"

#include <vector>

#include "base/check.h"

namespace viewloom {
namespace {

vk::raii::PipelineLayout makeLayout(const Device& device, uint32_t push_bytes) {
  VIEWLOOM_CHECK(push_bytes <= device.info().limits.push_bytes_max);
  const vk::PushConstantRange range{.stageFlags = vk::ShaderStageFlagBits::eCompute,
                                    .size = push_bytes};
  return {device.handle(),
          {.pushConstantRangeCount = push_bytes > 0 ? 1u : 0u, .pPushConstantRanges = &range}};
}

vk::raii::Pipeline makePipeline(const Device& device, const ComputePassOptions& options,
                                vk::PipelineLayout layout) {
  const vk::raii::ShaderModule module(
      device.handle(), {.codeSize = options.spirv.size_bytes(), .pCode = options.spirv.data()});
  std::vector<vk::SpecializationMapEntry> entries;
  for (uint32_t id = 0; id < options.specialization.size(); ++id) {
    entries.push_back({.constantID = id,
                       .offset = id * static_cast<uint32_t>(sizeof(uint32_t)),
                       .size = sizeof(uint32_t)});
  }
  const vk::SpecializationInfo specialization{
      .mapEntryCount = static_cast<uint32_t>(entries.size()),
      .pMapEntries = entries.data(),
      .dataSize = options.specialization.size_bytes(),
      .pData = options.specialization.data()};
  const vk::PipelineShaderStageCreateInfo stage{.stage = vk::ShaderStageFlagBits::eCompute,
                                                .module = *module,
                                                .pName = "main",
                                                .pSpecializationInfo = &specialization};
  return {device.handle(), nullptr,
          vk::ComputePipelineCreateInfo{.stage = stage, .layout = layout}};
}

}  // namespace

ComputePass::ComputePass(const Device& device, const ComputePassOptions& options)
    : push_bytes_(options.push_bytes),
      layout_(makeLayout(device, options.push_bytes)),
      pipeline_(makePipeline(device, options, *layout_)) {
  const auto raw_handle = reinterpret_cast<uint64_t>(static_cast<VkPipeline>(*pipeline_));
  device.setName(vk::ObjectType::ePipeline, raw_handle, options.debug_name);
}

void ComputePass::record(vk::CommandBuffer commands, std::span<const std::byte> push,
                         uint32_t groups_x, uint32_t groups_y, uint32_t groups_z) const {
  VIEWLOOM_CHECK(push.size() == push_bytes_);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline_);
  if (!push.empty()) {
    commands.pushConstants(*layout_, vk::ShaderStageFlagBits::eCompute, 0,
                           static_cast<uint32_t>(push.size()), push.data());
  }
  commands.dispatch(groups_x, groups_y, groups_z);
}

}  // namespace viewloom
