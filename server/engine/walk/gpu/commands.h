// SPDX-License-Identifier: Apache-2.0
// A recording for the device: copies and barriers, and what the passes of this folder add.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "gpu/buffer.h"
#include "gpu/vulkan_names.h"

namespace viewloom {

// The size that stands for all that lies behind the offset.
inline constexpr uint64_t kToTheEnd = UINT64_MAX;

struct CopiedBytes {
  uint64_t from_offset = 0;
  uint64_t to_offset = 0;
  uint64_t size_bytes = 0;
};

// A light handle of a recording; copies of it record into the same one. Its methods do not
// synchronise: barriers do. Offsets and sizes are multiples of 4, except for copy(). Thread-safety:
// none.
class Commands {
 public:
  explicit Commands(VkCommandBuffer_T* handle) : handle_(handle) {}
  VkCommandBuffer_T* handle() const { return handle_; }

  void copy(const Buffer& from, const Buffer& to, const CopiedBytes& bytes) const;
  // Every word of the buffer, or of a part of it.
  void fill(const Buffer& target, uint32_t word) const;
  void fill(const Buffer& target, uint64_t offset, uint64_t size_bytes, uint32_t word) const;
  // At most 64 KiB, which are kept with the recording.
  void write(const Buffer& target, std::span<const std::byte> bytes) const;

 private:
  VkCommandBuffer_T* handle_;
};

// Barriers: execution and memory dependencies between GPU work; "writes of the first are seen by
// the second". This one is between compute shaders recorded before and after (reads and writes).
void recordComputeBarrier(Commands commands);
void recordComputeToTransfer(Commands commands);
void recordTransferToCompute(Commands commands);
// The CPU reads mapped memory once the submission's timeline value is reached.
void recordComputeToHost(Commands commands);
void recordTransferToHost(Commands commands);

}  // namespace viewloom
