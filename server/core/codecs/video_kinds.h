// SPDX-License-Identifier: Apache-2.0
// The video encoders that this program is built with.
#pragma once

#include <vector>

#include "video/encoder_kind.h"

namespace viewloom {

// The preferred ones first, OpenH264 last. With VIEWLOOM_HARDWARE_VIDEO also those of GPUs, through
// libavcodec; they are listed whether this machine has such a GPU or not.
std::vector<VideoEncoderKind> videoEncoderKinds();

}  // namespace viewloom
