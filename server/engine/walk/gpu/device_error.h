// SPDX-License-Identifier: Apache-2.0
// Errors of the graphics device in words that say what to do, and the findings of its validation
// layers.
#pragma once

#include <cstdint>
#include <exception>
#include <mutex>
#include <string>
#include <vector>

#include "gpu/vulkan_names.h"

namespace viewloom {

// Text for a user: memory has run out, or the driver has given up, with the driver's own words in
// brackets. Other errors keep their text.
std::string deviceErrorText(const std::exception& error);

// Whether the device, or this computer, has no memory left for what was asked of it.
bool isOutOfDeviceMemory(const std::exception& error);

// Whether the driver failed at something that it may well do later: the device is reset just now,
// memory is short. False where this machine lacks a driver, or a driver lacks what is asked of it.
bool mayPass(const std::exception& error);

// Warnings and errors of the validation layers of one device, so that tests can fail on any of
// them. Thread-safety: all methods may be called from any thread.
class ValidationLog {
 public:
  void add(std::string message);
  uint64_t messageCount() const;
  // The first kKeptCount messages, oldest first.
  std::vector<std::string> messages() const;

  // Reports to this log, which must outlive the messenger; core and synchronization validation.
  vk::DebugUtilsMessengerCreateInfoEXT messengerCreateInfo();

  static constexpr size_t kKeptCount = 32;

 private:
  mutable std::mutex mutex_;
  uint64_t message_count_ = 0;
  std::vector<std::string> kept_;
};

}  // namespace viewloom
