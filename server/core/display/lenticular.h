// SPDX-License-Identifier: Apache-2.0
// Lenticular panels in their own px: every subpixel shows what is seen from where its lens sends
// it.
#pragma once

#include "display/atlas_layout.h"
#include "display/tile_grid.h"

namespace viewloom {

// Errors name the field as "lenticular.calibration_json". NOT_FOUND for a preset that does not
// exist, FAILED_PRECONDITION for one whose panel no calibration is published of.
absl::Status complete(LenticularSpec& lenticular);

// What follows expects a completed spec.
TileGrid tileGrid(const LenticularSpec& lenticular);
// One view, from the middle of the cone.
void describe(const LenticularSpec& lenticular, const StreamDefaults& defaults,
              AtlasLayout& layout);

}  // namespace viewloom
