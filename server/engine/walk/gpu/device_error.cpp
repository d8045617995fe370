// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_error.h"

#include <cstdio>
#include <new>
#include <utility>

#include "base/str_cat.h"
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

std::string deviceErrorText(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return "this computer has no memory left";
  }
  const auto* const problem = dynamic_cast<const vk::SystemError*>(&error);
  if (problem == nullptr) return error.what();
  const char* text = "the graphics driver reports an error";
  switch (static_cast<vk::Result>(problem->code().value())) {
    case vk::Result::eErrorOutOfDeviceMemory:
      text =
          "the graphics device has no memory left; publish smaller frames or fewer streams, or "
          "end other programs that use it";
      break;
    case vk::Result::eErrorOutOfHostMemory:
      text = "this computer has no memory left";
      break;
    case vk::Result::eErrorDeviceLost:
      text =
          "the graphics device stopped answering; start again, and update its driver if it "
          "does so more than once";
      break;
    default:
      break;
  }
  return strCat(text, " (", error.what(), ")");
}

bool isOutOfDeviceMemory(const std::exception& error) {
  return dynamic_cast<const vk::OutOfDeviceMemoryError*>(&error) != nullptr ||
         dynamic_cast<const vk::OutOfHostMemoryError*>(&error) != nullptr ||
         dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
}

bool mayPass(const std::exception& error) {
  const auto* const problem = dynamic_cast<const vk::SystemError*>(&error);
  if (problem == nullptr) return isOutOfDeviceMemory(error);
  switch (static_cast<vk::Result>(problem->code().value())) {
    case vk::Result::eErrorIncompatibleDriver:
    case vk::Result::eErrorLayerNotPresent:
    case vk::Result::eErrorExtensionNotPresent:
    case vk::Result::eErrorFeatureNotPresent:
      return false;
    default:
      return true;
  }
}

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
