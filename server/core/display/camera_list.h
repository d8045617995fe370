// SPDX-License-Identifier: Apache-2.0
// Any list of posed pinholes, by angles or by intrinsics; or a grid of them.
#pragma once

#include <string>
#include <vector>

#include "display/atlas_layout.h"
#include "display/tile_grid.h"

namespace viewloom {

// Errors name the field as "cameras.tile_size".
absl::Status complete(CamerasSpec& cameras);

// What follows expects a completed spec.
TileGrid tileGrid(const CamerasSpec& cameras);
// Views of a grid are counted in the order of its tiles: from the left, and from the top or the
// bottom as the order says.
void describe(const CamerasSpec& cameras, const StreamDefaults& defaults, AtlasLayout& layout);

// Errors name the camera as "<field>[i]".
absl::Status validateCameras(const std::vector<ViewCamera>& cameras, const std::string& field);

// Expects valid cameras.
std::vector<View> cameraViews(const std::vector<ViewCamera>& cameras, SizePx tile_size_px);

}  // namespace viewloom
