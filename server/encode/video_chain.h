// SPDX-License-Identifier: Apache-2.0
// The encoder that one display keeps from atlas to atlas.
#pragma once

#include <memory>

#include "video/video_encoder.h"

namespace viewloom {

// All its atlases are one stream. Thread-safety: none; one atlas of a display is coded at a time.
struct VideoChain {
  std::unique_ptr<VideoEncoder> encoder;  // nullptr = none yet
};

}  // namespace viewloom
