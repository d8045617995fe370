// SPDX-License-Identifier: Apache-2.0
// One frame from the files that hold it: a manifest, a deep file, or colour and depth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "files/frame_manifest.h"
#include "inputs/input_reader.h"

namespace viewloom::cli {

// Exactly one of them is given.
struct FrameFiles {
  std::string manifest;
  std::string deep;
  inputs::InputFiles input;

  // The file that stands for the frame in messages.
  const std::string& name() const;
};

struct LoaderOptions {
  uint32_t deep_layer_count_max = 0;  // 0 = as many as a frame may have
  bool has_black_sky = false;         // behind deep files
  inputs::InputSettings input;
};

struct LoadedFiles {
  files::LoadedFrame frame;
  std::optional<inputs::Interpretation> how;  // of colour and depth files
};

// Thread-safety: none; one owner.
class FrameLoader {
 public:
  explicit FrameLoader(const LoaderOptions& options) : options_(options), reader_(options.input) {}

  absl::StatusOr<LoadedFiles> load(const FrameFiles& files);

 private:
  absl::StatusOr<LoadedFiles> loadAny(const FrameFiles& files);
  absl::StatusOr<LoadedFiles> loadDeep(const std::string& file) const;

  LoaderOptions options_;
  inputs::InputReader reader_;
};

}  // namespace viewloom::cli
