// SPDX-License-Identifier: Apache-2.0
#include "gpu/commands.h"

#include "gpu/vulkan.h"

namespace viewloom {

void Commands::copy(const Buffer& from, const Buffer& to, const CopiedBytes& bytes) const {
  vk::CommandBuffer(handle_).copyBuffer(
      from.handle(), to.handle(),
      vk::BufferCopy{
          .srcOffset = bytes.from_offset, .dstOffset = bytes.to_offset, .size = bytes.size_bytes});
}

void Commands::fill(const Buffer& target, uint32_t word) const {
  fill(target, 0, VK_WHOLE_SIZE, word);
}

void Commands::fill(const Buffer& target, uint64_t offset, uint64_t size_bytes,
                    uint32_t word) const {
  vk::CommandBuffer(handle_).fillBuffer(target.handle(), offset, size_bytes, word);
}

void Commands::write(const Buffer& target, std::span<const std::byte> bytes) const {
  vk::CommandBuffer(handle_).updateBuffer(target.handle(), 0, bytes.size(), bytes.data());
}

}  // namespace viewloom
