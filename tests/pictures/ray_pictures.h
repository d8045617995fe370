// SPDX-License-Identifier: Apache-2.0
// Answers of the rays of a view in the row to draw.
#pragma once

#include <string>

#include "gpu/structure_image.h"
#include "gpu/walk_under_test.h"
#include "sweep/surface_row.h"

namespace viewloom::pictures {

// Each is an SVG file; `traced` is the view to draw.
std::string drawWalk(const StructureImage& structure, const TracedView& traced);
std::string drawSweep(const SurfaceRow& row, const TracedView& traced);
std::string drawFill(const SurfaceRow& row, const TracedView& traced);

}  // namespace viewloom::pictures
