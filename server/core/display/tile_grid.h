// SPDX-License-Identifier: Apache-2.0
// The tiles of a display and where they stand, before any stream is known.
#pragma once

#include <cstdint>

#include "display/display_kinds.h"

namespace viewloom {

struct TileGrid {
  const char* size_field;  // what the client would have to make smaller
  uint32_t columns;
  uint32_t rows;
  SizePx tile_size_px;
  TileOrder order;
  uint32_t view_count;
  uint64_t width_px;  // of the atlas; 64 bits: not yet known to be within limits
  uint64_t height_px;
  uint32_t image_count = 1;  // see AtlasLayout
};

}  // namespace viewloom
