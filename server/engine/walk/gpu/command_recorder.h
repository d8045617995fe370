// SPDX-License-Identifier: Apache-2.0
// A command buffer that is recorded and submitted again and again; each slot owns one.
#pragma once

#include "gpu/commands.h"
#include "gpu/timeline.h"

namespace viewloom {

// The device must outlive it. Thread-safety: none; one thread at a time.
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
