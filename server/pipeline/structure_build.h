// SPDX-License-Identifier: Apache-2.0
// What one frame's structure occupies on the device, with the commands that build it.
#pragma once

#include "gpu/command_recorder.h"
#include "structure/structure_slot.h"

namespace viewloom {

struct StructureBuild {
  StructureBuild(const Device& device, const FrameShape& shape)
      : slot(device, shape), recorder(device) {}

  StructureSlot slot;
  CommandRecorder recorder;
};

}  // namespace viewloom
