// SPDX-License-Identifier: Apache-2.0
// Submissions: the timeline that counts those that are finished, and command buffers that are
// recorded and submitted again and again.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>

#include "gpu/commands.h"
#include "gpu/device.h"

namespace viewloom {

// A count of finished submissions that CPU and GPU share. Values must be signalled in the order in
// which they are handed out: whoever takes one and submits what signals it holds submitting()
// meanwhile. The device must outlive it. Thread-safety: all methods may be called from any thread.
class Timeline {
 public:
  static constexpr uint64_t kForeverNs = std::numeric_limits<uint64_t>::max();

  explicit Timeline(const Device& device);

  std::mutex& submitting() { return submitting_; }
  // The value the next submission signals; the first is 1.
  uint64_t nextValue() { return ++last_value_; }
  // Waits until the value is reached; false = timed out, never with kForeverNs. Throws where nobody
  // can know any more whether the device is done: vk::DeviceLostError, or std::runtime_error where
  // there is no memory for the wait.
  bool wait(uint64_t value, uint64_t timeout_ns = kForeverNs) const;
  uint64_t completedValue() const;
  vk::Semaphore handle() const;

 private:
  bool waitOnce(uint64_t value, uint64_t timeout_ns) const;

  const Device* device_;
  Hidden<vk::raii::Semaphore> semaphore_;
  std::mutex submitting_;
  std::atomic<uint64_t> last_value_ = 0;
};

// A command buffer; each slot owns one. The device must outlive it. Thread-safety: none; one thread
// at a time.
class CommandRecorder {
 public:
  explicit CommandRecorder(const Device& device);

  // Starts over. The last submission must have reached its timeline value.
  Commands begin();
  // Ends the recording and submits it. Returns the value that `timeline` reaches when it is done.
  uint64_t submit(Timeline& timeline);

 private:
  const Device* device_;
  Hidden<vk::raii::CommandPool> pool_;
  Hidden<vk::raii::CommandBuffer> commands_;
};

}  // namespace viewloom
