// SPDX-License-Identifier: Apache-2.0
// What one strip of an atlas occupies on the device, with the commands that trace it.
#pragma once

#include <array>
#include <cstdint>

#include "gpu/command_recorder.h"
#include "trace/trace_slot.h"

namespace viewloom {

struct StripTrace {
  StripTrace(const Device& device, const TraceSlotShape& shape)
      : slot(device, shape), recorders{CommandRecorder(device), CommandRecorder(device)} {}

  TraceSlot slot;
  // Parts of a strip take turns: one is recorded while the device does the one before it.
  std::array<CommandRecorder, 2> recorders;
  std::array<uint64_t, 2> submitted = {};  // timeline values of their last submissions
};

}  // namespace viewloom
