// SPDX-License-Identifier: Apache-2.0
#include "cli/atlas_outputs.h"

#include <utility>

namespace viewloom::cli {

absl::StatusOr<std::unique_ptr<AtlasOutputs>> AtlasOutputs::open(const AtlasOutputOptions& options,
                                                                 StatusLine& line) {
  VIEWLOOM_RETURN_IF_ERROR(makeAtlasFolder(options.files.folder));
  std::unique_ptr<AtlasOutputs> outputs(new AtlasOutputs(line));
  if (!options.files.folder.empty()) outputs->files_.emplace(options.files);
  if (options.video.empty()) return outputs;
  auto video = AtlasVideo::create(options.video, options.files.stream);
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
