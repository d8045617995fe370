// SPDX-License-Identifier: Apache-2.0
// Execution and memory dependencies between GPU work; "writes of the first are seen by the second".
#pragma once

#include "gpu/commands.h"

namespace viewloom {

// Compute shaders recorded before, compute shaders recorded after (reads and writes).
void recordComputeBarrier(Commands commands);
void recordComputeToTransfer(Commands commands);
void recordTransferToCompute(Commands commands);
// The CPU reads mapped memory once the submission's timeline value is reached.
void recordComputeToHost(Commands commands);
void recordTransferToHost(Commands commands);

}  // namespace viewloom
