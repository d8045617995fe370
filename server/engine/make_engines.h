// SPDX-License-Identifier: Apache-2.0
// Which engines a server with this device has.
#pragma once

#include <cstdint>

#include "admission/memory_budget.h"
#include "engine/engines.h"
#include "gpu/device.h"

namespace viewloom {

struct EngineOptions {
  uint32_t trace_slot_count = 3;  // atlases, or strips of them, on their way at once
  // Compiles the kernels of likely displays while nobody waits.
  bool warms_up = false;
  // Frames and atlases are made in it. Outlives the engines.
  MemoryBudget& memory = unboundedMemory();
};

// Where the device is the CPU, views are swept where they can be: the same cores do it faster, and
// without it. A GPU walks everything: there the walk is faster than the CPU beside it. The device
// outlives them.
Engines makeEngines(const Device& device, const EngineOptions& options = {});

}  // namespace viewloom
