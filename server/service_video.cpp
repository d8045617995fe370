// SPDX-License-Identifier: Apache-2.0
#include "service_video.h"

#include <stdexcept>
#include <utility>

#include "base/log.h"
#include "base/str_cat.h"
#include "codecs/video_kinds.h"

namespace viewloom {

VideoEncoderChoicePtr chooseVideoEncoder(const std::string& wanted) {
  auto choice = VideoEncoderChoice::choose(videoEncoderKinds(), wanted);
  if (!choice.ok()) {
    throw std::runtime_error(strCat("pipeline.video_encoder: ", choice.status().message()));
  }
  // Where nothing is named, a machine without a GPU is nothing to warn of.
  const LogLevel level =
      wanted == VideoEncoderChoice::kAutomatic ? LogLevel::kInfo : LogLevel::kWarning;
  for (const EncoderProbe& probe : (*choice)->probes()) {
    if (probe.status.ok()) continue;
    log(level, "video: ", probe.name, " cannot be used: ", probe.status.message());
  }
  log(LogLevel::kInfo, "video: encoded by ", (*choice)->text());
  return *std::move(choice);
}

}  // namespace viewloom
