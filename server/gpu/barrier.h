// SPDX-License-Identifier: Apache-2.0
// Execution and memory dependencies between GPU work; "writes of the first are seen by the second".
#pragma once

#include "gpu/vulkan.h"

namespace viewloom {

// Compute shaders recorded before, compute shaders recorded after (reads and writes).
void recordComputeBarrier(vk::CommandBuffer commands);
void recordComputeToTransfer(vk::CommandBuffer commands);
void recordTransferToCompute(vk::CommandBuffer commands);
// The CPU reads mapped memory once the submission's timeline value is reached.
void recordComputeToHost(vk::CommandBuffer commands);
void recordTransferToHost(vk::CommandBuffer commands);

}  // namespace viewloom
