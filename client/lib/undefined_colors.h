// SPDX-License-Identifier: Apache-2.0
// Colours of pixels without surface, chosen so that a picture takes few bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "frame/size.h"

namespace viewloom {

// Gives each pixel without surface the mean colour of the surfaces in its block of 16x16 px, or
// else the colour of the block before. Edges of such regions then cost few bits, and surfaces
// beside them keep their colour.
//
// `inv_z`: float[height][width], kNoInvZ where there is no surface (lib/inverse_depth.h). `colors`:
// uint8_t[height][width][pixel_bytes]; 3 or 4 bytes a pixel, of which three are written.
void fillUndefinedColors(std::span<const float> inv_z, SizePx size_px, size_t pixel_bytes,
                         std::span<uint8_t> colors);

}  // namespace viewloom
