// SPDX-License-Identifier: Apache-2.0
#include "video/openh264_kind.h"

#include <utility>

#include <wels/codec_api.h>

#include "base/str_cat.h"
#include "video/openh264_encoder.h"

namespace viewloom {

VideoEncoderKind openH264Kind() {
  OpenH264Version version = {};
  WelsGetCodecVersionEx(&version);
  return {
      .name = std::string(kOpenH264Name),
      .library = strCat("OpenH264 ", version.uMajor, ".", version.uMinor, ".", version.uRevision),
      .limit = {},
      .make = [](const VideoFormat& format) -> absl::StatusOr<std::unique_ptr<VideoEncoder>> {
        auto made = OpenH264Encoder::make(format);
        VIEWLOOM_RETURN_IF_ERROR(made.status());
        return std::unique_ptr<VideoEncoder>(*std::move(made));
      }};
}

}  // namespace viewloom
