// SPDX-License-Identifier: Apache-2.0
// From places among the texels of a row to colour, with the vectors of the CPU it runs on.
#pragma once

#include <cstddef>
#include <cstdint>

namespace viewloom {

// Writes rgba[width_px], R, G, B, 255 in memory order. `texels`: packed codes (packed_codes.h), two
// at least.
// `places`: 1/256 px, at whose two texels light is blended; negative: the background, which is as
// rgba. Nothing has to be aligned to more than its type.
void colorRow(const uint32_t* texels, uint32_t texel_count, const int32_t* places, size_t width_px,
              uint32_t background, uint32_t* rgba);

}  // namespace viewloom
