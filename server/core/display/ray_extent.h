// SPDX-License-Identifier: Apache-2.0
// Bounds of the rays of a display with more than one eye a view. They lie between the outermost
// rays.
#pragma once

#include <vector>

#include "display/atlas_layout.h"

namespace viewloom {

// Views from each corner of the rectangle around all eyes. All rays, also those of samples, lie
// between the pixels 0 and size_px of each.
struct RayExtent {
  std::vector<Camera> corners;
  SizePx size_px;
};

// Bounds of a layout. Expects rays that do not all come from their view's eye.
RayExtent rayExtent(const AtlasLayout& layout);

}  // namespace viewloom
