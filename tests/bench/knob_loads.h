// SPDX-License-Identifier: Apache-2.0
// Loads for the quality: pictures of each application of the tracer, and their true pictures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "display/display_spec.h"
#include "frame/frame.h"
#include "scoring/image_score.h"

namespace viewloom::bench {

struct KnobLoad {
  std::string application;
  FramePtr frame;
  DisplaySpec display;            // what quality decides is left open
  ScoredImage truth;              // of the whole atlas, sRGB
  std::vector<uint8_t> is_known;  // [height][width]: 1 where the frame's layers hold what is seen
};

// Views beside the source, a tracked pair, a view through a lens, an atlas between frames, a rough
// mirror. All of them `by` times smaller on a side, but the atlas between frames.
std::vector<KnobLoad> knobLoads(uint32_t by);

}  // namespace viewloom::bench
