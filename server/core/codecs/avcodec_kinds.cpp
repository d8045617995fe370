// SPDX-License-Identifier: Apache-2.0
#include "codecs/avcodec_encoder.h"
#include "codecs/video_kinds.h"
#include "video/openh264_kind.h"

namespace viewloom {
namespace {

// Most GPUs encode H.264 up to this side. Some stop at a height of 2176 px.
constexpr uint32_t kGpuSideMax_px = 4096;
constexpr PictureLimit kGpuLimit = {.area_max_px = kVideoAreaOfLevel6_px,
                                    .side_max_px = kGpuSideMax_px};
constexpr PictureLimit kLevel6 = {.area_max_px = kVideoAreaOfLevel6_px};

AvcodecEncoder::Form nvencForm() {
  return {.name = "h264_nvenc",
          .limit = kGpuLimit,
          .options = {{"preset", "p4"},
                      {"tune", "ull"},
                      {"rc", "constqp"},
                      {"profile", "main"},
                      {"coder", "cabac"},
                      {"dpb_size", "1"},  // the option refs fails on GPUs that have no other
                      {"delay", "0"},
                      {"zerolatency", "1"},
                      {"forced-idr", "1"}}};
}

AvcodecEncoder::Form vaapiForm() {
  return {.name = "h264_vaapi",
          .limit = kGpuLimit,
          .has_vaapi = true,
          .options = {{"rc_mode", "CQP"},
                      {"refs", "1"},
                      {"profile", "main"},
                      {"coder", "cabac"},
                      {"sei", "0"},
                      {"async_depth", "1"}}};
}

// For tests, and for those who name it: it takes more time than OpenH264.
AvcodecEncoder::Form x264Form() {
  return {.name = "libx264",
          .limit = kLevel6,
          .takes_slices = true,
          .options = {{"preset", "superfast"},
                      {"refs", "1"},
                      {"tune", "zerolatency"},
                      {"profile", "main"},
                      {"wpredp", "0"},
                      {"sc_threshold", "0"},
                      {"forced-idr", "1"}}};
}

VideoEncoderKind kindOf(const AvcodecEncoder::Form& form, bool is_gpu) {
  return {.name = form.name,
          .library = AvcodecEncoder::library(),
          .limit = form.limit,
          .tried_px = is_gpu ? SizePx{kGpuSideMax_px, kGpuSideMax_px} : SizePx{},
          .is_automatic = is_gpu,
          .make = [form](const VideoFormat& format) { return AvcodecEncoder::make(form, format); }};
}

}  // namespace

std::vector<VideoEncoderKind> videoEncoderKinds() {
  return {kindOf(nvencForm(), true), kindOf(vaapiForm(), true), kindOf(x264Form(), false),
          openH264Kind()};
}

}  // namespace viewloom
