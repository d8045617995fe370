// SPDX-License-Identifier: Apache-2.0
#include "cli/atlas_outputs.h"

#include <utility>

#include "recording/file_encoder.h"

namespace viewloom::cli {

void addVideoEncoderOption(const usage::Command& app, std::string& encoder) {
  app.add("--video-encoder", encoder,
          "Encoder of a video; a wrong name lists those of this program\n"
          "auto   one that takes large quilts unscaled, if this program has one\n"
          "       that works here; else openh264")
      .valueName("NAME")
      .showDefault();
}

void addVideoOptions(const usage::Command& app, AtlasOutputOptions& options) {
  app.add("--video", options.video,
          "Save the atlases as a video (MP4) for players of quilts; the name gets the layout")
      .valueName("FILE");
  addVideoEncoderOption(app, options.video_encoder);
}

absl::StatusOr<std::unique_ptr<AtlasOutputs>> AtlasOutputs::open(const AtlasOutputOptions& options,
                                                                 StatusLine& line) {
  VIEWLOOM_RETURN_IF_ERROR(makeAtlasFolder(options.files.folder));
  std::unique_ptr<AtlasOutputs> outputs(new AtlasOutputs(line));
  if (!options.files.folder.empty()) outputs->files_.emplace(options.files);
  if (options.video.empty()) return outputs;
  auto encoders = chooseFileEncoder(options.video_encoder);
  if (!encoders.ok()) return withFieldPrefix(encoders.status(), "--video-encoder");
  auto video = AtlasVideo::create(options.video, options.files.stream, *std::move(encoders));
  VIEWLOOM_RETURN_IF_ERROR(video.status());
  outputs->video_ = *std::move(video);
  return outputs;
}

void AtlasOutputs::beginInterruptible() {
  if (video_) {
    catchInterrupts();
  } else {
    limit_.emplace();
  }
}

absl::Status AtlasOutputs::write(const Atlas& atlas, int64_t arrived_ns) {
  if (files_) {
    const absl::StatusOr<AtlasFiles::Written> written = files_->write(atlas);
    VIEWLOOM_RETURN_IF_ERROR(written.status());
    line_.print(describe(*written));
  }
  return video_ ? video_->add(atlas, arrived_ns) : absl::OkStatus();
}

absl::Status AtlasOutputs::complete(int64_t now_ns) {
  if (!video_) return absl::OkStatus();
  VIEWLOOM_RETURN_IF_ERROR(video_->complete(now_ns));
  line_.print(video_->summary());
  return absl::OkStatus();
}

}  // namespace viewloom::cli
