// SPDX-License-Identifier: Apache-2.0
// The Y'CbCr planes of a picture, as libjpeg-turbo's own conversion makes them: the truth.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "display/color_form.h"

namespace viewloom::test {

// Planes as YcbcrLayout has them, of uint8_t[row][stride_bytes], R, G, B, ignored. `form`: not
// kRgba.
std::vector<uint8_t> ycbcrPlanesOf(std::span<const uint8_t> rgbx, size_t stride_bytes,
                                   SizePx size_px, ColorForm form);
// Planes of rows without gaps; R in the low byte.
std::vector<uint8_t> ycbcrPlanesOf(std::span<const uint32_t> rgbx, SizePx size_px, ColorForm form);

}  // namespace viewloom::test
