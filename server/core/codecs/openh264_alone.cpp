// SPDX-License-Identifier: Apache-2.0
#include "codecs/video_kinds.h"
#include "video/openh264_kind.h"

namespace viewloom {

std::vector<VideoEncoderKind> videoEncoderKinds() {
  return {openH264Kind()};
}

}  // namespace viewloom
