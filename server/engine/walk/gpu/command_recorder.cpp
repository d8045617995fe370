// SPDX-License-Identifier: Apache-2.0
#include "gpu/command_recorder.h"

#include <utility>

#include "gpu/vulkan.h"

namespace viewloom {
namespace {

vk::raii::CommandBuffer allocateCommands(const Device& device, vk::CommandPool pool) {
  vk::raii::CommandBuffers commands(device.handle(),
                                    {.commandPool = pool, .commandBufferCount = 1});
  return std::move(commands.front());
}

}  // namespace

CommandRecorder::CommandRecorder(const Device& device)
    : device_(&device),
      pool_(
          hide(vk::raii::CommandPool(device.handle(), {.queueFamilyIndex = device.queueFamily()}))),
      commands_(hide(allocateCommands(device, **pool_))) {}

Commands CommandRecorder::begin() {
  pool_->reset();
  commands_->begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  return Commands(**commands_);
}

uint64_t CommandRecorder::submit(Timeline& timeline) {
  commands_->end();
  const vk::CommandBufferSubmitInfo commands{.commandBuffer = **commands_};
  std::lock_guard lock(timeline.submitting());
  const vk::SemaphoreSubmitInfo signal{.semaphore = timeline.handle(),
                                       .value = timeline.nextValue(),
                                       .stageMask = vk::PipelineStageFlagBits2::eAllCommands};
  device_->submit({.commandBufferInfoCount = 1,
                   .pCommandBufferInfos = &commands,
                   .signalSemaphoreInfoCount = 1,
                   .pSignalSemaphoreInfos = &signal});
  return signal.value;
}

}  // namespace viewloom
