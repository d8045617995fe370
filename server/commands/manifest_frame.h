// SPDX-License-Identifier: Apache-2.0
// Reads what `render` is given: frames and displays as JSON of their protos.
#pragma once

#include <filesystem>

#include "base/status.h"
#include "display/display_spec.h"
#include "frame/frame.h"

namespace viewloom {

// The frame of a FrameManifest, checked and decoded as if it had come over the wire.
absl::StatusOr<FramePtr> readManifestFrame(const std::filesystem::path& path);

// A Display, completed. Unknown keys are errors.
absl::StatusOr<DisplaySpec> readDisplayFile(const std::filesystem::path& path);

}  // namespace viewloom
