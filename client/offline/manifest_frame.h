// SPDX-License-Identifier: Apache-2.0
// Frames and displays of the commands that work offline: from files, or the synthetic scene.
#pragma once

#include <filesystem>
#include <vector>

#include "base/status.h"
#include "display/display_spec.h"
#include "files/deep_layers.h"
#include "frame/frame.h"
#include "synthetic/synthetic_frame.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom {

struct ManifestFrame {
  FramePtr frame;
  std::vector<files::DeepReport> deep;  // of the sources that are deep files
};

// The frame of a FrameManifest, checked and decoded as if it had come over the wire.
absl::StatusOr<ManifestFrame> readManifestFrame(const std::filesystem::path& path);
// The same of a manifest at hand; its file names are meant from the folder.
absl::StatusOr<ManifestFrame> loadManifestFrame(const v1::FrameManifest& manifest,
                                                const std::filesystem::path& folder);

// The synthetic scene, by the same way.
FramePtr makeSyntheticFrame(const SyntheticOptions& options);

// A Display, completed. Unknown keys are errors.
absl::StatusOr<DisplaySpec> readDisplayFile(const std::filesystem::path& path);

}  // namespace viewloom
