// SPDX-License-Identifier: Apache-2.0
// A kind of video encoder that this program can try: a library, or a device behind it.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/status.h"
#include "video/picture_limit.h"
#include "video/video_encoder.h"

namespace viewloom {

using MakeVideoEncoder =
    std::function<absl::StatusOr<std::unique_ptr<VideoEncoder>>(const VideoFormat& format)>;

struct VideoEncoderKind {
  std::string name;     // in settings: "openh264", "h264_nvenc"
  std::string library;  // with its version: "OpenH264 2.3.1"
  PictureLimit limit;   // largest pictures
  // A picture that not every machine takes, although it is within the limit. Where an encoder for
  // it cannot be made, the limit is that of OpenH264. Empty = the limit holds everywhere.
  SizePx tried_px;
  bool is_automatic = true;  // false = taken only where it is named
  MakeVideoEncoder make;     // errors as OpenH264Encoder::make; from any thread
};

}  // namespace viewloom
