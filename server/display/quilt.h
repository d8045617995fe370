// SPDX-License-Identifier: Apache-2.0
// Quilts: N off-axis views from a line, never toed in, as lenticular panels show them.
#pragma once

#include <vector>

#include "display/atlas_layout.h"

namespace viewloom {

// Of one view as shown.
double quiltAspect(const QuiltSpec& quilt);
SizePx quiltTileSize(const QuiltSpec& quilt);

// Expects a completed spec. The N views share the cone evenly and each stands in the middle of its
// share: view i at x = D * tan(cone * ((i + 0.5) / N - 0.5)). View 0 is the leftmost.
std::vector<View> quiltViews(const QuiltSpec& quilt, const StreamDefaults& defaults);

}  // namespace viewloom
