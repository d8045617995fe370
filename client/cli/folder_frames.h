// SPDX-License-Identifier: Apache-2.0
// A folder as a feed: every complete file, or pair of files, that comes into it is a frame.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "cli/file_pairs.h"
#include "cli/first_look.h"
#include "cli/folder_watch.h"
#include "cli/frame_feed.h"

namespace viewloom::cli {

class FolderFrames final : public FrameFeed {
 public:
  // The errors of FolderWatch::open.
  static absl::StatusOr<std::unique_ptr<FolderFrames>> open(const std::filesystem::path& folder,
                                                            const LoaderOptions& options,
                                                            const std::string& view);

  // Files that cannot be read are skipped, with a note.
  absl::StatusOr<std::optional<WireFrame>> next(double elapsed_s) override;
  bool hasEnded() const override { return false; }
  std::string description() const override;
  std::vector<std::string> takeNotes() override;
  std::vector<std::string> takeLastNotes() override;
  bool isLive() const override { return false; }

 private:
  FolderFrames(std::string name, std::unique_ptr<FolderWatch> watch, FilePairs pairs,
               const LoaderOptions& options);
  absl::Status lookForFiles();
  void skip(const std::string& file, const std::string& reason);

  const std::string name_;
  std::unique_ptr<FolderWatch> watch_;
  FilePairs pairs_;
  FrameLoader loader_;
  std::deque<FrameFiles> ready_;  // at most kReadyMax
  bool has_told_how_ = false;
  uint64_t published_count_ = 0;
  uint64_t skipped_count_ = 0;
  std::vector<std::string> notes_;
  FirstLook look_;
};

}  // namespace viewloom::cli
