// SPDX-License-Identifier: Apache-2.0
// Integral imaging: microlenses in front of a panel, behind each the elemental image that it shows
// to all directions at once (Lippmann 1908; near the eye: Lanman and Luebke, "Near-Eye Light Field
// Displays", 2013).
#pragma once

#include <span>

#include "display/atlas_layout.h"
#include "display/tile_grid.h"

namespace viewloom {

struct IntegralPreset {
  const char* name;
  const char* device;
  SizePx panel_px;
  double pixel_pitch_m;
  double lens_pitch_m;
  double focal_length_m;
  const char* note;
};

// Sorted by name. None is verified on hardware.
std::span<const IntegralPreset> integralPresets();

// Errors name the field as "integral.lens_pitch_m". NOT_FOUND for a preset that does not exist.
absl::Status complete(IntegralSpec& integral);

// What follows expects a completed spec.
TileGrid tileGrid(const IntegralSpec& integral);
void describe(const IntegralSpec& integral, const StreamDefaults& defaults, AtlasLayout& layout);

}  // namespace viewloom
