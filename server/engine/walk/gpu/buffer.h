// SPDX-License-Identifier: Apache-2.0
// A GPU buffer with its own memory; shaders reach it by a descriptor, or by its 64-bit address.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "gpu/device.h"

namespace viewloom {

enum class MemoryIntent : uint8_t {
  kDeviceOnly,  // fastest for the device, never mapped
  kUpload,      // written by the CPU, read by the device once
  kReadback     // written by the device, read by the CPU from its cache
};

struct BufferOptions {
  uint64_t size_bytes = 0;  // > 0
  MemoryIntent intent = MemoryIntent::kDeviceOnly;
  const char* debug_name = "";
};

// Counts in gpuMemoryBytes() as long as it lives.
class CountedMemory {
 public:
  CountedMemory() = default;
  explicit CountedMemory(uint64_t size_bytes);
  ~CountedMemory();
  CountedMemory(CountedMemory&& other) noexcept
      : size_bytes_(std::exchange(other.size_bytes_, 0)) {}
  CountedMemory& operator=(CountedMemory&& other) noexcept;

 private:
  uint64_t size_bytes_ = 0;
};

// Invariant: empty, or a buffer bound to memory of its own (coherent and mapped unless
// kDeviceOnly). The device must outlive it. Throws when the device cannot hold it
// (isOutOfDeviceMemory). Thread-safety: const methods may be called from any thread; what mapped()
// holds is the caller's care.
class Buffer {
 public:
  Buffer() = default;
  Buffer(const Device& device, const BufferOptions& options);

  vk::Buffer handle() const;
  uint64_t address() const { return address_; }
  uint64_t sizeBytes() const { return size_bytes_; }
  std::span<std::byte> mapped() const { return {mapped_, mapped_ ? size_bytes_ : 0}; }

 private:
  Hidden<vk::raii::DeviceMemory> memory_;
  CountedMemory counted_;
  Hidden<vk::raii::Buffer> buffer_;
  uint64_t size_bytes_ = 0;
  uint64_t address_ = 0;
  std::byte* mapped_ = nullptr;
};

// GPU allocations of this process so far; what proves that warm slots allocate nothing.
uint64_t gpuAllocationCount();
// Bytes allocated for its buffers: on the device, and where the CPU writes or reads.
uint64_t gpuMemoryBytes();

enum class TexelFormat : uint8_t { kR32Uint, kRg32Uint, kRgba32Uint, kR32Float };

// Reads a buffer as a one-dimensional image of texels. The buffer must outlive it.
class TexelView {
 public:
  TexelView() = default;
  // Throws vk::SystemError. At most DeviceLimits::texel_count_max texels.
  TexelView(const Device& device, const Buffer& buffer, TexelFormat format);

  bool isEmpty() const { return !view_; }
  vk::BufferView handle() const;

 private:
  Hidden<vk::raii::BufferView> view_;
};

}  // namespace viewloom
