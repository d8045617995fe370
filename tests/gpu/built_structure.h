// SPDX-License-Identifier: Apache-2.0
// A frame's structure on a device, for tests of what reads it.
#pragma once

#include <utility>

#include "gpu/submission.h"
#include "structure/frame_structure.h"
#include "structure/structure_builder.h"
#include "support/test_frames.h"

namespace viewloom {

struct BuiltFrame {
  BuiltFrame(const Device& device, StructureBuilder& builder, FramePtr built)
      : frame(std::move(built)), structure(device, shapesOf(*frame)) {
    structure.upload(*frame);
    Timeline timeline(device);
    CommandRecorder recorder(device);
    structure.recordBuild(recorder.begin(), builder);
    timeline.wait(recorder.submit(timeline));
  }

  const SourceFormat& source() const { return frame->format.sources.front(); }

  FramePtr frame;
  FrameStructure structure;
};

}  // namespace viewloom
