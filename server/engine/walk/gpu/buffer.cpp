// SPDX-License-Identifier: Apache-2.0
#include "gpu/buffer.h"

#include <atomic>

#include "base/check.h"
#include "base/str_cat.h"
#include "gpu/vulkan.h"

namespace viewloom {
namespace {

using Property = vk::MemoryPropertyFlagBits;

std::atomic<uint64_t> allocation_count = 0;
std::atomic<uint64_t> memory_bytes = 0;

// Best kind first; Vulkan promises that the last one exists.
std::span<const vk::MemoryPropertyFlags> preferences(MemoryIntent intent) {
  static const vk::MemoryPropertyFlags kDevice[] = {Property::eDeviceLocal, {}};
  static const vk::MemoryPropertyFlags kUpload[] = {Property::eHostVisible |
                                                    Property::eHostCoherent};
  static const vk::MemoryPropertyFlags kReadback[] = {
      Property::eHostVisible | Property::eHostCoherent | Property::eHostCached,
      Property::eHostVisible | Property::eHostCoherent};
  switch (intent) {
    case MemoryIntent::kUpload:
      return kUpload;
    case MemoryIntent::kReadback:
      return kReadback;
    case MemoryIntent::kDeviceOnly:
      break;
  }
  return kDevice;
}

uint32_t memoryType(const Device& device, uint32_t allowed_types, MemoryIntent intent) {
  const auto memory = device.physicalDevice().getMemoryProperties();
  for (const vk::MemoryPropertyFlags wanted : preferences(intent)) {
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
      const bool allowed = (allowed_types >> i) & 1u;
      if (allowed && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    }
  }
  throw vk::FeatureNotPresentError("the device offers no host-visible coherent memory");
}

vk::raii::Buffer makeBuffer(const Device& device, const BufferOptions& options) {
  VIEWLOOM_CHECK(options.size_bytes > 0);
  if (options.size_bytes > device.info().limits.allocation_bytes_max) {
    throw vk::OutOfDeviceMemoryError(strCat(options.debug_name, " needs a buffer of ",
                                            options.size_bytes, " bytes; the device allows ",
                                            device.info().limits.allocation_bytes_max));
  }
  using Usage = vk::BufferUsageFlagBits;
  return {device.handle(),
          {.size = options.size_bytes,
           .usage = Usage::eStorageBuffer | Usage::eTransferSrc | Usage::eTransferDst |
                    Usage::eUniformBuffer | Usage::eUniformTexelBuffer | Usage::eIndirectBuffer |
                    Usage::eShaderDeviceAddress}};
}

vk::raii::DeviceMemory makeMemory(const Device& device, const vk::MemoryRequirements& needs,
                                  MemoryIntent intent) {
  const vk::MemoryAllocateFlagsInfo flags{.flags = vk::MemoryAllocateFlagBits::eDeviceAddress};
  ++allocation_count;
  return {device.handle(),
          {.pNext = &flags,
           .allocationSize = needs.size,
           .memoryTypeIndex = memoryType(device, needs.memoryTypeBits, intent)}};
}

vk::Format formatOf(TexelFormat format) {
  switch (format) {
    case TexelFormat::kRg32Uint:
      return vk::Format::eR32G32Uint;
    case TexelFormat::kRgba32Uint:
      return vk::Format::eR32G32B32A32Uint;
    case TexelFormat::kR32Float:
      return vk::Format::eR32Sfloat;
    case TexelFormat::kR32Uint:
      break;
  }
  return vk::Format::eR32Uint;
}

}  // namespace

CountedMemory::CountedMemory(uint64_t size_bytes) : size_bytes_(size_bytes) {
  memory_bytes += size_bytes;
}

CountedMemory::~CountedMemory() {
  memory_bytes -= size_bytes_;
}

CountedMemory& CountedMemory::operator=(CountedMemory&& other) noexcept {
  memory_bytes -= size_bytes_;
  size_bytes_ = std::exchange(other.size_bytes_, 0);
  return *this;
}

Buffer::Buffer(const Device& device, const BufferOptions& options)
    : buffer_(hide(makeBuffer(device, options))) {
  const vk::MemoryRequirements needs = buffer_->getMemoryRequirements();
  memory_ = hide(makeMemory(device, needs, options.intent));
  counted_ = CountedMemory(needs.size);
  buffer_->bindMemory(**memory_, 0);
  size_bytes_ = options.size_bytes;
  address_ = device.handle().getBufferAddress({.buffer = **buffer_});
  if (options.intent != MemoryIntent::kDeviceOnly) {
    mapped_ = static_cast<std::byte*>(memory_->mapMemory(0, VK_WHOLE_SIZE));
  }
  const auto raw_handle = reinterpret_cast<uint64_t>(static_cast<VkBuffer>(**buffer_));
  device.setName(vk::ObjectType::eBuffer, raw_handle, options.debug_name);
}

vk::Buffer Buffer::handle() const {
  return **buffer_;
}

uint64_t gpuAllocationCount() {
  return allocation_count;
}

uint64_t gpuMemoryBytes() {
  return memory_bytes;
}

TexelView::TexelView(const Device& device, const Buffer& buffer, TexelFormat format)
    : view_(hide(vk::raii::BufferView(
          device.handle(),
          vk::BufferViewCreateInfo{
              .buffer = buffer.handle(), .format = formatOf(format), .range = VK_WHOLE_SIZE}))) {}

vk::BufferView TexelView::handle() const {
  return **view_;
}

}  // namespace viewloom
