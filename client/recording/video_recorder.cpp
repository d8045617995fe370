// SPDX-License-Identifier: Apache-2.0
#include "recording/video_recorder.h"

#include <utility>

namespace viewloom {

absl::StatusOr<std::unique_ptr<VideoRecorder>> VideoRecorder::create(
    const std::filesystem::path& path, const std::string& title, const Clock& clock,
    VideoEncoderChoicePtr encoders) {
  auto video = AtlasVideo::create(path, title, std::move(encoders));
  VIEWLOOM_RETURN_IF_ERROR(video.status());
  return std::unique_ptr<VideoRecorder>(new VideoRecorder(*std::move(video), clock));
}

VideoRecorder::VideoRecorder(std::unique_ptr<AtlasVideo> video, const Clock& clock)
    : video_(std::move(video)), clock_(clock) {}

absl::Status VideoRecorder::add(const v1::StreamAtlasesResponse& message) {
  if (message.has_header()) is_within_atlas_ = true;
  if (message.has_layout() || message.has_abandoned() || message.has_end()) {
    is_within_atlas_ = false;
  }
  v1::StreamAtlasesResponse copy = message;
  const absl::StatusOr<std::optional<Atlas>> atlas = assembler_.add(std::move(copy));
  VIEWLOOM_RETURN_IF_ERROR(atlas.status());
  if (!atlas->has_value()) return absl::OkStatus();
  return video_->add(**atlas, clock_.nowNs());
}

}  // namespace viewloom
