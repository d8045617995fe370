// SPDX-License-Identifier: Apache-2.0
// Image files and manifests as a feed.
#pragma once

#include <string>
#include <vector>

#include "cli/frame_feed.h"
#include "cli/plane_options.h"
#include "files/frame_manifest.h"

namespace viewloom::cli {

// The i-th files of the lists are the i-th frame.
struct FileFeedOptions {
  std::vector<std::string> manifests;  // these, or deeps, or colors
  std::vector<std::string> deeps;
  uint32_t deep_layer_count_max = 0;  // 0 = as many as a frame may have
  bool has_black_sky = false;         // behind deep files
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
  // What splitting deep files cost, once for each.
  std::vector<std::string> takeNotes() override;
  bool isLive() const override { return false; }

 private:
  size_t frameCount() const;
  const std::vector<std::string>& firstFiles() const;
  absl::StatusOr<files::LoadedFrame> load(size_t index) const;
  absl::StatusOr<v1::FrameManifest> manifestOf(size_t index) const;

  const FileFeedOptions options_;
  size_t next_index_ = 0;
  bool is_repeating_ = false;
  std::vector<std::string> notes_;
  // A single frame is read once, however often it is shown.
  std::optional<WireFrame> only_frame_;
};

}  // namespace viewloom::cli
