// SPDX-License-Identifier: Apache-2.0
#include "gpu/barrier.h"

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

void recordBarrier(vk::CommandBuffer commands, const Scope& before, const Scope& after) {
  const vk::MemoryBarrier2 barrier{.srcStageMask = before.stages,
                                   .srcAccessMask = before.accesses,
                                   .dstStageMask = after.stages,
                                   .dstAccessMask = after.accesses};
  commands.pipelineBarrier2(
      vk::DependencyInfo{.memoryBarrierCount = 1, .pMemoryBarriers = &barrier});
}

}  // namespace

void recordComputeBarrier(vk::CommandBuffer commands) {
  recordBarrier(commands, kComputeWrites, kComputeUses);
}

void recordComputeToTransfer(vk::CommandBuffer commands) {
  recordBarrier(commands, kComputeWrites, kTransferUses);
}

void recordTransferToCompute(vk::CommandBuffer commands) {
  recordBarrier(commands, kTransferWrites, kComputeUses);
}

void recordComputeToHost(vk::CommandBuffer commands) {
  recordBarrier(commands, kComputeWrites, kHostReads);
}

void recordTransferToHost(vk::CommandBuffer commands) {
  recordBarrier(commands, kTransferWrites, kHostReads);
}

}  // namespace viewloom
