// SPDX-License-Identifier: Apache-2.0
// Displays that make their own views: one view and its depth as grey, or two layers of them.
#pragma once

#include <span>

#include "display/atlas_layout.h"
#include "display/tile_grid.h"

namespace viewloom {

struct RgbdPreset {
  const char* name;
  const char* device;
  RgbdForm form;
  const char* note;
};

// Sorted by name. None is verified on hardware, and px of none are published.
std::span<const RgbdPreset> rgbdPresets();

// Errors name the field as "rgbd.view_size". NOT_FOUND for a preset that does not exist.
absl::Status complete(RgbdSpec& rgbd);

// What follows expects a completed spec.
TileGrid tileGrid(const RgbdSpec& rgbd);
// All tiles from one eye, in the middle of the display. The range of the codes may come out empty,
// where one end of it is the stream's: see validateDepthCodes.
void describe(const RgbdSpec& rgbd, const StreamDefaults& defaults, AtlasLayout& layout);

// Of what describe() made. FAILED_PRECONDITION: what the stream gives and what the display says
// leave no range of depths.
absl::Status validateDepthCodes(const DepthCodes& codes);

// Whether there are codes among its colour.
bool showsDepth(const DisplaySpec& spec);
// Whether its atlas is complete only with the plane of 16-bit codes.
bool hasDepthPlane(const DisplaySpec& spec);
// Whether it asks for what lies behind the first surface.
bool hasLayerBehind(const DisplaySpec& spec);

}  // namespace viewloom
