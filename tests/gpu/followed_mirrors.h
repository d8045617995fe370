// SPDX-License-Identifier: Apache-2.0
// Reflected rays of the px of random scenes, as the server traces them, before the oracle's judge.
#pragma once

#include <string>
#include <vector>

#include "gpu/mirror_stage.h"
#include "gpu/shaders/followed_abi.h"
#include "oracle/judge.h"
#include "trace/albedos.h"

namespace viewloom {

// The frame of a scene all of whose surfaces mirror, by their own slopes.
FramePtr mirroringFrameOf(const oracle::Scene& scene);

// Hits of the rays that px of these views send on, once: [view][row][column].
struct FollowedViews {
  SourceStats stats;
  std::vector<abi::RayRecord> records;  // of the px's own rays; as what follows
  std::vector<abi::FollowedRay> followed;
};

// Has its kernels compiled. The device must outlive it. Thread-safety: none.
class MirrorFollower {
 public:
  explicit MirrorFollower(const Device& device);

  FollowedViews follow(const oracle::Scene& scene, const std::vector<oracle::OutputView>& views,
                       double tolerance_px);

 private:
  // Rays of all px of an atlas.
  std::vector<abi::FollowedRay> follow(MirrorStage& stage);

  const Device& device_;
  MirrorKernels kernels_;
  Albedos albedos_;
  ComputePass pass_;
};

// Verdict on rays that passed behind something, by oracle/passed_body.h.
struct JudgedBodies {
  uint64_t count = 0;
  uint64_t met_count = 0;      // by what was tested; as the next
  uint64_t passed_count = 0;   // seen from rim to rim, and not met
  uint64_t excused_count = 0;  // not the oracle's answer, but one to the ray hardly moved
  uint64_t differing_count = 0;

  void add(const JudgedBodies& other);
};

// Verdict on all of them.
struct JudgedMirrors {
  oracle::Verdict verdict;
  JudgedBodies bodies;
  uint64_t bent_count = 0;    // rays along their own facet
  uint64_t back_count = 0;    // that came out through a surface
  uint64_t deeper_count = 0;  // from layers behind the first

  void add(const JudgedMirrors& other);
  std::string summary() const;
};
JudgedMirrors judgeMirrors(MirrorFollower& follower, const oracle::Scene& scene,
                           const std::vector<oracle::OutputView>& views, double tolerance_px,
                           const std::string& where);

}  // namespace viewloom
