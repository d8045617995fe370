// SPDX-License-Identifier: Apache-2.0
// Frames of photos.
#pragma once

#include "base/status.h"
#include "files/frame_manifest.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::inputs {

// Of a source as interpret() made it: one layer, whose colour is a photo and whose depth is in the
// same file, or in one of its own that manifests can name. Not numbered. Errors name the file.
absl::StatusOr<files::LoadedFrame> loadPhotoFrame(const v1::SourceFiles& source);

}  // namespace viewloom::inputs
