// SPDX-License-Identifier: Apache-2.0
// Image files and manifests as a feed.
#pragma once

#include <string>
#include <vector>

#include "cli/frame_feed.h"
#include "cli/plane_options.h"

namespace viewloom::cli {

// The i-th files of the lists are the i-th frame.
struct FileFeedOptions {
  std::vector<std::string> manifests;  // these, or colors
  std::vector<std::string> colors;
  std::vector<std::string> depths;  // none = the colour file, an EXR, has depth too
  std::string view;                 // of multi-view EXR files; "" = the default one
  PlaneOptions planes;
  bool is_looping = false;
};

class FileFrames final : public FrameFeed {
 public:
  // Checks the lists against each other; files are read as their frames come due.
  static absl::Status validate(const FileFeedOptions& options);
  explicit FileFrames(FileFeedOptions options);

  absl::StatusOr<std::optional<WireFrame>> next(double elapsed_s) override;
  std::string description() const override;
  bool isLive() const override { return false; }

 private:
  size_t frameCount() const;
  absl::StatusOr<WireFrame> load(size_t index) const;
  absl::StatusOr<v1::FrameManifest> manifestOf(size_t index) const;

  const FileFeedOptions options_;
  size_t next_index_ = 0;
  // A single frame is read once, however often it is shown.
  std::optional<WireFrame> only_frame_;
};

}  // namespace viewloom::cli
