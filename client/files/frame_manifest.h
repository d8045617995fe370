// SPDX-License-Identifier: Apache-2.0
// Manifests: JSON that names the files of a frame, and frames made from it.
#pragma once

#include <filesystem>

#include "base/status.h"
#include "lib/wire_frame.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::files {

// Unknown keys are errors. Relative file names inside are meant from the manifest's folder.
absl::StatusOr<v1::FrameManifest> readFrameManifest(const std::filesystem::path& path);
absl::StatusOr<v1::TruthManifest> readTruthManifest(const std::filesystem::path& path);

// Reads every file of the manifest. Errors name the field of the manifest, and the file. What is no
// matter of files, as the camera, is copied unseen: whoever takes the frame checks it.
absl::StatusOr<WireFrame> loadFrame(const v1::FrameManifest& manifest,
                                    const std::filesystem::path& folder);

}  // namespace viewloom::files
