// SPDX-License-Identifier: Apache-2.0
#include "gpu/submission.h"

#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include "base/str_cat.h"
#include "gpu/device_error.h"
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

// A driver that gives up too early is asked again.
constexpr uint64_t kPatience_ns = 1'000'000'000;
// Where a driver has no memory to wait with, it is asked again for a second.
constexpr int kAttempts = 100;
constexpr std::chrono::milliseconds kAttemptPause{10};

}  // namespace

Timeline::Timeline(const Device& device)
    : device_(&device), semaphore_(hide(makeSemaphore(device))) {}

bool Timeline::wait(uint64_t value, uint64_t timeout_ns) const {
  if (timeout_ns != kForeverNs) return waitOnce(value, timeout_ns);
  while (!waitOnce(value, kPatience_ns)) {
  }
  return true;
}

bool Timeline::waitOnce(uint64_t value, uint64_t timeout_ns) const {
  const vk::Semaphore semaphore = **semaphore_;
  const vk::SemaphoreWaitInfo info{
      .semaphoreCount = 1, .pSemaphores = &semaphore, .pValues = &value};
  for (int attempt = 1;; ++attempt) {
    try {
      return device_->handle().waitSemaphores(info, timeout_ns) == vk::Result::eSuccess;
    } catch (const vk::SystemError& error) {
      if (!isOutOfDeviceMemory(error)) throw;
      // Not an error of missing memory: those let go of what the device may still use.
      if (attempt == kAttempts) throw std::runtime_error(deviceErrorText(error));
    }
    std::this_thread::sleep_for(kAttemptPause);
  }
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
