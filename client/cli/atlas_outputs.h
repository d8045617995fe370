// SPDX-License-Identifier: Apache-2.0
// Outputs of `viewloom watch`: files in a folder, a video, or nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "cli/atlas_files.h"
#include "cli/interrupt.h"
#include "cli/status_line.h"
#include "recording/atlas_video.h"
#include "usage/command_line.h"

namespace viewloom::cli {

struct AtlasOutputOptions {
  AtlasFileOptions files;              // folder "" = none are written
  std::string video;                   // MP4 to write; "" = none
  std::string video_encoder = "auto";  // as chooseFileEncoder takes it

  // Whether files have the bytes of JPEG that the server made.
  bool keepsJpeg() const {
    return !files.folder.empty() && !files.writes_png && !files.writes_views;
  }
};

// Adds --video-encoder, for commands that write videos.
void addVideoEncoderOption(const usage::Command& app, std::string& encoder);
// Adds --video and --video-encoder.
void addVideoOptions(const usage::Command& app, AtlasOutputOptions& options);

// Thread-safety: none; one owner at a time.
class AtlasOutputs {
 public:
  // Names of files, and the summary of the video, go to `line`, which must outlive this.
  // INVALID_ARGUMENT when a target cannot be written.
  static absl::StatusOr<std::unique_ptr<AtlasOutputs>> open(const AtlasOutputOptions& options,
                                                            StatusLine& line);

  // From now on an interrupt ends the command in order. Without a video that takes less than a
  // second: see InterruptLimit. With one, its end is worth waiting for.
  void beginInterruptible();
  bool isEmpty() const { return !files_ && !video_; }

  // Errors as AtlasFiles::write and AtlasVideo::add.
  absl::Status write(const Atlas& atlas, int64_t arrived_ns);
  // Ends the video, also after an error: pictures that came before are kept. Errors as
  // AtlasVideo::complete. Call once.
  absl::Status complete(int64_t now_ns);

 private:
  explicit AtlasOutputs(StatusLine& line) : line_(line) {}

  StatusLine& line_;
  std::optional<AtlasFiles> files_;
  std::unique_ptr<AtlasVideo> video_;
  std::optional<InterruptLimit> limit_;
};

}  // namespace viewloom::cli
