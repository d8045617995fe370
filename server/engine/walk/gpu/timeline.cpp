// SPDX-License-Identifier: Apache-2.0
#include "gpu/timeline.h"

#include "gpu/vulkan.h"

namespace viewloom {
namespace {

vk::raii::Semaphore makeSemaphore(const Device& device) {
  const vk::SemaphoreTypeCreateInfo type{.semaphoreType = vk::SemaphoreType::eTimeline};
  return {device.handle(), {.pNext = &type}};
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

}  // namespace viewloom
