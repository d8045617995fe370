// SPDX-License-Identifier: Apache-2.0
// A plane that kernels write and the CPU reads.
#pragma once

#include <cstdint>
#include <span>

#include "gpu/buffer.h"
#include "gpu/commands.h"

namespace viewloom {

// On a device whose memory is the CPU's, one buffer; elsewhere a device buffer and the copy of it.
class ReadablePlane {
 public:
  ReadablePlane() = default;
  ReadablePlane(const Device& device, uint64_t size_bytes, const char* name)
      : readback_(
            device,
            {.size_bytes = size_bytes, .intent = MemoryIntent::kReadback, .debug_name = name}),
        is_direct_(device.info().shares_memory) {
    if (!is_direct_) device_only_ = Buffer(device, {.size_bytes = size_bytes, .debug_name = name});
  }

  bool isEmpty() const { return readback_.sizeBytes() == 0; }
  const Buffer& target() const { return is_direct_ ? readback_ : device_only_; }
  // Where kernels write it; 0 = empty.
  uint64_t address() const { return isEmpty() ? 0 : target().address(); }
  // Makes what kernels wrote readable: a barrier, and a copy where one is needed.
  void recordReadback(Commands commands, uint64_t size_bytes) const {
    if (isEmpty() || is_direct_) return;
    commands.copy(device_only_, readback_, {.size_bytes = size_bytes});
  }
  std::span<const std::byte> bytes() const { return readback_.mapped(); }
  std::span<std::byte> mutableBytes() { return readback_.mapped(); }

 private:
  Buffer device_only_;
  Buffer readback_;
  bool is_direct_ = true;
};

}  // namespace viewloom
