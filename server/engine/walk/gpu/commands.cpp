// SPDX-License-Identifier: Apache-2.0
#include "gpu/commands.h"

#include "gpu/vulkan.h"

namespace viewloom {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;

struct Scope {
  vk::PipelineStageFlags2 stages;
  vk::AccessFlags2 accesses;
};

const Scope kComputeWrites{Stage::eComputeShader, Access::eShaderWrite};
// Groups of a dispatch may be what a shader has written.
const Scope kComputeUses{Stage::eComputeShader | Stage::eDrawIndirect,
                         Access::eShaderRead | Access::eUniformRead | Access::eShaderWrite |
                             Access::eIndirectCommandRead};
const Scope kTransferWrites{Stage::eAllTransfer, Access::eTransferWrite};
const Scope kTransferUses{Stage::eAllTransfer, Access::eTransferRead | Access::eTransferWrite};
const Scope kHostReads{Stage::eHost, Access::eHostRead};

void recordBarrier(Commands commands, const Scope& before, const Scope& after) {
  const vk::MemoryBarrier2 barrier{.srcStageMask = before.stages,
                                   .srcAccessMask = before.accesses,
                                   .dstStageMask = after.stages,
                                   .dstAccessMask = after.accesses};
  vk::CommandBuffer(commands.handle())
      .pipelineBarrier2(vk::DependencyInfo{.memoryBarrierCount = 1, .pMemoryBarriers = &barrier});
}

}  // namespace

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

void recordComputeBarrier(Commands commands) {
  recordBarrier(commands, kComputeWrites, kComputeUses);
}

void recordComputeToTransfer(Commands commands) {
  recordBarrier(commands, kComputeWrites, kTransferUses);
}

void recordTransferToCompute(Commands commands) {
  recordBarrier(commands, kTransferWrites, kComputeUses);
}

void recordComputeToHost(Commands commands) {
  recordBarrier(commands, kComputeWrites, kHostReads);
}

void recordTransferToHost(Commands commands) {
  recordBarrier(commands, kTransferWrites, kHostReads);
}

}  // namespace viewloom
