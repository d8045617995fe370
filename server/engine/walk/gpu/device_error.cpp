// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_error.h"

#include "base/str_cat.h"
#include "gpu/vulkan.h"

namespace viewloom {

std::string deviceErrorText(const std::exception& error) {
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
  return dynamic_cast<const vk::OutOfDeviceMemoryError*>(&error) != nullptr;
}

}  // namespace viewloom
