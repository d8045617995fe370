// SPDX-License-Identifier: Apache-2.0
// Stereo pairs: two off-axis eyes on a line, or two given cameras. Of a tracked display, the eyes
// until others come (tracked_eyes.h).
#pragma once

#include "display/atlas_layout.h"
#include "display/tile_grid.h"

namespace viewloom {

// Errors name the field as "stereo.eye_size".
absl::Status complete(StereoSpec& stereo);

// What follows expects a completed spec.
TileGrid tileGrid(const StereoSpec& stereo);
// Left, right; without given cameras at -/+ half the eye distance, both framing one rectangle on
// the focal plane.
void describe(const StereoSpec& stereo, const StreamDefaults& defaults, AtlasLayout& layout);

}  // namespace viewloom
