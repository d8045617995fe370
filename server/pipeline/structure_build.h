// SPDX-License-Identifier: Apache-2.0
// One frame in the forms that tracers take it in.
#pragma once

#include <memory>

#include "gpu/command_recorder.h"
#include "structure/frame_structure.h"
#include "sweep/sweep_source.h"

namespace viewloom {

// What the walk needs of a frame, on the device, with the commands that build it.
struct WalkedForm {
  WalkedForm(const Device& device, const FrameBuildMemory& build_memory)
      : structure(device, build_memory), recorder(device) {}

  FrameStructure structure;
  CommandRecorder recorder;
};

// Owner decides which thread has it: the structure loop's until the structure is resident, then
// the GPU loop's, which may build the walked form late; `swept` does not change then.
struct StructureBuild {
  explicit StructureBuild(std::vector<FrameShape> source_shapes)
      : shapes(std::move(source_shapes)) {}

  const std::vector<FrameShape> shapes;  // of the frame's sources
  bool is_swept = false;                 // the frame in hand has the form for sweeps
  SweepSource swept;  // keeps the last frame that was swept until the next one comes
  // Allocated when a display of such frames first needs it; holds the frame in hand if is_walked.
  std::unique_ptr<WalkedForm> walked;
  bool is_walked = false;

  // The walked form is to be built in this memory, whose shapes are these. Throws when the device
  // cannot hold it (isOutOfDeviceMemory).
  void prepareWalked(const Device& device, const FrameBuildMemory& build_memory) {
    if (walked) {
      walked->structure.buildIn(build_memory);
    } else {
      walked = std::make_unique<WalkedForm>(device, build_memory);
    }
  }
};

}  // namespace viewloom
