// SPDX-License-Identifier: Apache-2.0
#include "gpu/validation_log.h"

#include <cstdio>
#include <utility>

#include "gpu/vulkan.h"

namespace viewloom {
namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* message,
                                         void* log) {
  static_cast<ValidationLog*>(log)->add(message->pMessage);
  return VK_FALSE;  // the call that caused it goes on
}

}  // namespace

void ValidationLog::add(std::string message) {
  std::fprintf(stderr, "vulkan validation: %s\n", message.c_str());
  std::lock_guard lock(mutex_);
  ++message_count_;
  if (kept_.size() < kKeptCount) kept_.push_back(std::move(message));
}

uint64_t ValidationLog::messageCount() const {
  std::lock_guard lock(mutex_);
  return message_count_;
}

std::vector<std::string> ValidationLog::messages() const {
  std::lock_guard lock(mutex_);
  return kept_;
}

vk::DebugUtilsMessengerCreateInfoEXT ValidationLog::messengerCreateInfo() {
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
  return {.messageSeverity = Severity::eWarning | Severity::eError,
          .messageType = Type::eValidation | Type::ePerformance,
          .pfnUserCallback = onMessage,
          .pUserData = this};
}

}  // namespace viewloom
