// SPDX-License-Identifier: Apache-2.0
#include "gpu/barrier.h"

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
