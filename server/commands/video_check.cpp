// SPDX-License-Identifier: Apache-2.0
// Whether video can be encoded on this machine, and by what.
#include <vector>

#include "absl/strings/str_format.h"
#include "base/str_cat.h"
#include "codecs/video_kinds.h"
#include "commands/doctor_checks.h"
#include "video/encoder_choice.h"
#include "video/openh264_kind.h"

namespace viewloom {
namespace {

std::string remedyOf(const EncoderProbe& probe) {
  if (probe.name == kOpenH264Name) return "reinstall the package libopenh264-7";
  return "install the driver of the GPU and its video library, or leave it to others: viewloomd "
         "takes another encoder";
}

Finding judge(const EncoderProbe& probe) {
  const std::string name = strCat(probe.name, " (", probe.library, ")");
  if (!probe.status.ok()) {
    return {Verdict::kAdvice, "video", strCat(name, " cannot be used: ", probe.status.message()),
            remedyOf(probe)};
  }
  return {Verdict::kFine, "video",
          absl::StrFormat("%s: %.1f dB, %.1f ms for %dx%d px", name, probe.psnr_db,
                          probe.picture_ms, kProbePicture_px.width, kProbePicture_px.height),
          ""};
}

}  // namespace

std::vector<Finding> checkVideo(const Config& config) {
  const std::vector<VideoEncoderKind> kinds = videoEncoderKinds();
  std::vector<Finding> findings;
  findings.reserve(kinds.size() + 1);
  for (const VideoEncoderKind& kind : kinds) findings.push_back(judge(probeVideoEncoder(kind)));
  const auto choice = VideoEncoderChoice::choose(kinds, config.pipeline.video_encoder);
  if (!choice.ok()) {
    findings.push_back({Verdict::kProblem, "video",
                        strCat("pipeline.video_encoder: ", choice.status().message()),
                        "name one of these with --pipeline.video_encoder"});
  } else if (kinds.size() > 1) {
    findings.push_back({Verdict::kFine, "video", strCat("would use ", (*choice)->text()), ""});
  }
  return findings;
}

}  // namespace viewloom
