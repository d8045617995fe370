// SPDX-License-Identifier: Apache-2.0
// What one strip of an atlas occupies on the device, with the commands that trace it.
#pragma once

#include "gpu/command_recorder.h"
#include "trace/trace_slot.h"

namespace viewloom {

struct StripTrace {
  StripTrace(const Device& device, const TraceSlotShape& shape)
      : slot(device, shape), recorder(device) {}

  TraceSlot slot;
  CommandRecorder recorder;
};

}  // namespace viewloom
