// SPDX-License-Identifier: Apache-2.0
// Build and walk as the server runs them, on scenes and views of the oracle; with a planted fault
// if asked.
#pragma once

#include <memory>
#include <vector>

#include "frame/frame.h"
#include "gpu/command_recorder.h"
#include "gpu/structure_image.h"
#include "oracle/scene_generator.h"
#include "oracle/view_generator.h"
#include "structure/structure_builder.h"
#include "trace/view_tracer.h"

namespace viewloom {

// The frame of a scene: inv_z as binary32 disparity, colour of the same size.
FramePtr frameOf(const oracle::Scene& scene);

// What the oracle sees of a built scene: with the connection tolerance that the build settled on.
oracle::OracleSource sourceOf(const oracle::Scene& scene, const StructureSlot& slot);

// Thread-safety: none.
class WalkUnderTest {
 public:
  explicit WalkUnderTest(const Device& device);

  // Uploads and builds, and waits for it.
  std::unique_ptr<StructureSlot> build(const Frame& frame);
  StructureImage readBack(const StructureSlot& slot);
  // Records of views of one size, [view][row][column].
  std::vector<std::vector<abi::RayRecord>> trace(const StructureSlot& slot,
                                                 const std::vector<oracle::OutputView>& views,
                                                 double tolerance_px);

 private:
  template <typename Element>
  std::vector<Element> read(const Buffer& buffer);

  const Device& device_;
  StructureBuilder builder_;
  ViewTracer tracer_;
  CommandRecorder recorder_;
  Timeline timeline_;
};

}  // namespace viewloom
