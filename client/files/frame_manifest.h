// SPDX-License-Identifier: Apache-2.0
// Manifests: JSON that names the files of a frame, and frames made from it.
#pragma once

#include <filesystem>
#include <vector>

#include "base/status.h"
#include "files/deep_layers.h"
#include "lib/wire_frame.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::files {

// Unknown keys are errors. Relative file names inside are meant from the manifest's folder.
absl::StatusOr<v1::FrameManifest> readFrameManifest(const std::filesystem::path& path);
absl::StatusOr<v1::TruthManifest> readTruthManifest(const std::filesystem::path& path);

struct LoadedFrame {
  WireFrame wire;
  std::vector<DeepReport> deep;  // of the sources that are deep files, in their order
  // Largest code of whole numbers, 0 for floats: for the depth of each layer that is no deep
  // file's, in the order of sources and layers.
  std::vector<uint32_t> code_max;
};

// Reads every file of the manifest. Errors name the field of the manifest, and the file. What is no
// matter of files, as the camera, is copied unseen: whoever takes the frame checks it.
absl::StatusOr<LoadedFrame> loadFrame(const v1::FrameManifest& manifest,
                                      const std::filesystem::path& folder);

}  // namespace viewloom::files
