// SPDX-License-Identifier: Apache-2.0
// What the validation layers said, so that tests can fail on any of it.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "gpu/vulkan_names.h"

namespace viewloom {

// Warnings and errors of one device. Thread-safety: all methods may be called from any thread.
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
