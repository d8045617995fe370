// SPDX-License-Identifier: Apache-2.0
// Image files and manifests as a feed, and the options that name them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/first_look.h"
#include "cli/frame_feed.h"
#include "cli/frame_loader.h"
#include "usage/command_line.h"

namespace viewloom::cli {

// The i-th files of the lists are the i-th frame.
struct FileFeedOptions {
  std::vector<std::string> manifests;  // these, or deeps, or colors
  std::vector<std::string> deeps;
  std::vector<std::string> colors;
  std::vector<std::string> depths;  // none = the colour file has depth too
  std::string view;                 // of multi-view EXR files; "" = the default one
  LoaderOptions loader;
  bool is_looping = false;
};

// Options that say what files are, given where there are none or where files say all themselves:
// INVALID_ARGUMENT with the first of them. `what`: "--synthetic".
absl::Status refuseFileOptions(const FileFeedOptions& options, const std::string& what);
// Checks which options may be used with deep files.
absl::Status validateDeep(const FileFeedOptions& options);
// The lists checked against each other, frame by frame: of video files, as many as they hold.
absl::StatusOr<std::vector<FrameFiles>> framesOf(const FileFeedOptions& options);
// Cost of splitting a deep file, in a line.
std::string noteOf(const files::DeepReport& deep);

// Files are read as their frames come due.
class FileFrames final : public FrameFeed {
 public:
  // `frames`: at least one.
  FileFrames(const FileFeedOptions& options, std::vector<FrameFiles> frames);

  absl::StatusOr<std::optional<WireFrame>> next(double elapsed_s) override;
  std::string description() const override;
  // The cost of splitting each deep file, the reading of the first other file, and suspicions.
  std::vector<std::string> takeNotes() override;
  std::vector<std::string> takeLastNotes() override;
  bool isLive() const override { return false; }

 private:
  void note(const FrameFiles& files, const LoadedFiles& loaded);

  const std::vector<FrameFiles> frames_;
  const bool is_looping_;
  FrameLoader loader_;
  size_t next_index_ = 0;
  bool is_repeating_ = false;
  bool has_told_how_ = false;
  std::vector<std::string> notes_;
  FirstLook look_;
  // A single frame is read once, however often it is shown.
  std::optional<WireFrame> only_frame_;
};

// Adds the options that name the files.
void addFileOptions(const usage::Command& app, FileFeedOptions& options);

}  // namespace viewloom::cli
