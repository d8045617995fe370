// SPDX-License-Identifier: Apache-2.0
// Any list of posed pinholes, by angles or by intrinsics.
#pragma once

#include <string>
#include <vector>

#include "display/atlas_layout.h"

namespace viewloom {

// Errors name the camera as "<field>[i]".
absl::Status validateCameras(const std::vector<ViewCamera>& cameras, const std::string& field);

// Expects valid cameras.
std::vector<View> cameraViews(const std::vector<ViewCamera>& cameras, SizePx tile_size_px);

}  // namespace viewloom
