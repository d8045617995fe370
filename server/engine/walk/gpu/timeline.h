// SPDX-License-Identifier: Apache-2.0
// A count of finished submissions that CPU and GPU share.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>

#include "gpu/device.h"

namespace viewloom {

// Values must be signalled in the order in which they are handed out: whoever takes one and submits
// what signals it holds submitting() meanwhile. The device must outlive it.
// Thread-safety: all methods may be called from any thread.
class Timeline {
 public:
  static constexpr uint64_t kForeverNs = std::numeric_limits<uint64_t>::max();

  explicit Timeline(const Device& device);

  std::mutex& submitting() { return submitting_; }
  // The value the next submission signals; the first is 1.
  uint64_t nextValue() { return ++last_value_; }
  // Waits until the value is reached; false = timed out. Throws vk::DeviceLostError.
  bool wait(uint64_t value, uint64_t timeout_ns = kForeverNs) const;
  uint64_t completedValue() const;
  vk::Semaphore handle() const;

 private:
  const Device* device_;
  Hidden<vk::raii::Semaphore> semaphore_;
  std::mutex submitting_;
  std::atomic<uint64_t> last_value_ = 0;
};

}  // namespace viewloom
