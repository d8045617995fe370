// SPDX-License-Identifier: Apache-2.0
#include "gpu/submission.h"

#include <utility>

#include "gpu/vulkan.h"

namespace viewloom {
namespace {

vk::raii::Semaphore makeSemaphore(const Device& device) {
  const vk::SemaphoreTypeCreateInfo type{.semaphoreType = vk::SemaphoreType::eTimeline};
  return {device.handle(), {.pNext = &type}};
}

vk::raii::CommandBuffer allocateCommands(const Device& device, vk::CommandPool pool) {
  vk::raii::CommandBuffers commands(device.handle(),
                                    {.commandPool = pool, .commandBufferCount = 1});
  return std::move(commands.front());
}

}  // namespace

Timeline::Timeline(const Device& device)
    : device_(&device), semaphore_(hide(makeSemaphore(device))) {}

bool Timeline::wait(uint64_t value, uint64_t timeout_ns) const {
  const vk::Semaphore semaphore = **semaphore_;
  const vk::Result result = device_->handle().waitSemaphores(
      {.semaphoreCount = 1, .pSemaphores = &semaphore, .pValues = &value}, timeout_ns);
  return result == vk::Result::eSuccess;
}

uint64_t Timeline::completedValue() const {
  return semaphore_->getCounterValue();
}

vk::Semaphore Timeline::handle() const {
  return **semaphore_;
}

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
