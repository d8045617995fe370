// SPDX-License-Identifier: Apache-2.0
// Several sources built and traced together as the server does, on scenes and views of the oracle.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/walk_under_test.h"
#include "oracle/merge_judge.h"
#include "structure/frame_structure.h"

namespace viewloom {

struct PosedScene {
  oracle::Scene scene;
  bool is_cube_map = false;  // planes as of gpu/cube_scenes.h
  glm::dvec3 position_m{0.0};
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
};

// At most three sources: each is of one colour channel alone, so that the colour of a px says what
// share each has in it. Opaque 8-bit, or as what may be semitransparent.
FramePtr frameOf(const std::vector<PosedScene>& scenes, bool is_half_float);

struct MergedView {
  int width = 0;
  std::vector<oracle::MergedAnswer> answers;  // [row][column]
};

// Thread-safety: none.
class SourcesUnderTest {
 public:
  explicit SourcesUnderTest(const Device& device);

  const Device& device() const { return device_; }
  void build(const Frame& frame);
  const FrameStructure& structure() const { return *structure_; }
  // Views of one size, in the world.
  std::vector<MergedView> trace(const std::vector<oracle::OutputView>& views, double tolerance_px);

 private:
  const Device& device_;
  StructureBuilder builder_;
  ViewTracer tracer_;
  CommandRecorder recorder_;
  Timeline timeline_;
  std::optional<FrameStructure> structure_;
  std::vector<SeenSource> sources_;
};

struct JudgedRays {
  double tolerance_px = 0;
  bool is_half_float = false;
  std::string name;  // of what is judged, for messages
};

// Every ray of the views.
oracle::Verdict judgeScenes(SourcesUnderTest& tracer, const std::vector<PosedScene>& scenes,
                            const std::vector<oracle::OutputView>& views, const JudgedRays& rays);

// Every ray of random views of the sources of a seed: some see the same from elsewhere, some
// contradict each other.
oracle::Verdict judgeSources(SourcesUnderTest& tracer, uint64_t seed);

}  // namespace viewloom
