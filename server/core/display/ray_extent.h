// SPDX-License-Identifier: Apache-2.0
// How far the rays of a display with more than one eye a view go apart: what holds for the
// outermost holds for all.
#pragma once

#include <vector>

#include "display/atlas_layout.h"

namespace viewloom {

// The view from each corner of the rectangle of all eyes; between the px 0 and size_px of each lie
// all its rays, those of samples too.
struct RayExtent {
  std::vector<Camera> corners;
  SizePx size_px;
};

// Expects rays that do not all come from their view's eye.
RayExtent rayExtent(const AtlasLayout& layout);

}  // namespace viewloom
