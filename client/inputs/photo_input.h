// SPDX-License-Identifier: Apache-2.0
// Photos: what their files say of camera, colour and depth, and the frames made of them.
#pragma once

#include "base/status.h"
#include "files/frame_manifest.h"
#include "inputs/interpretation.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::inputs {

// Completes `result`. With a depth file of its own the photo is colour and camera alone, and the
// kind of input says what its depth is.
absl::Status interpretPhoto(const InputSettings& settings, const InputFiles& files,
                            Interpretation& result);

// The frame of a source as interpret() made it: one layer, whose colour is a photo and whose depth
// is in the same file, or in one of its own that manifests can name. Not numbered. Errors name the
// file.
absl::StatusOr<files::LoadedFrame> loadPhotoFrame(const v1::SourceFiles& source);

}  // namespace viewloom::inputs
