// SPDX-License-Identifier: Apache-2.0
// A scene with mirrors as a source in a camera's place has it, and as that camera truly sees it.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/world_views.h"
#include "support/truth/mirrored.h"

namespace viewloom {

struct SeenMirrors {
  Camera camera;
  SizePx view_px;
  FramePtr frame;
  std::vector<glm::vec3> truth;  // linear light: [height][width]
};

struct MirrorSource {
  uint32_t fineness = 1;  // px on a side for one of the view
  uint32_t layer_count = 1;
};

// Camera with so many times the px of a view, each way.
Camera finer(Camera camera, uint32_t times);

SeenMirrors seenBy(const Camera& camera, SizePx view_px, const truth::Scene& scene,
                   const MirrorSource& source, const truth::MirrorOptions& options);

// By how many codes each channel of each px is off the truth. `frame`: the scene's, or one that
// holds the same.
std::vector<double> apartCodes(OfflineRenderer& renderer, const SeenMirrors& seen,
                               const Frame& frame, const ReflectionSpec& reflection);

}  // namespace viewloom
