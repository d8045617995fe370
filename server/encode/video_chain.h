// SPDX-License-Identifier: Apache-2.0
// Encoders that one display keeps from atlas to atlas.
#pragma once

#include <memory>
#include <vector>

#include "video/video_encoder.h"

namespace viewloom {

// Each picture of the stack is a stream of its own, which one encoder codes.
// Thread-safety: none; one atlas of a display is coded at a time.
struct VideoChain {
  std::vector<std::unique_ptr<VideoEncoder>> encoders;  // of each picture; nullptr = none yet
};

}  // namespace viewloom
