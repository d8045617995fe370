// SPDX-License-Identifier: Apache-2.0
// Quilts: N off-axis views from a line, never toed in, as lenticular panels show them.
#pragma once

#include <vector>

#include "display/atlas_layout.h"
#include "display/tile_grid.h"

namespace viewloom {

// Errors name the field as "quilt.columns". NOT_FOUND for a preset that does not exist.
absl::Status complete(QuiltSpec& quilt);

// What follows expects a completed spec.
TileGrid tileGrid(const QuiltSpec& quilt);
void describe(const QuiltSpec& quilt, const StreamDefaults& defaults, AtlasLayout& layout);

// Of one view as shown.
double quiltAspect(const QuiltSpec& quilt);

// Where view i of N stands on the line of eyes, m from its middle, for a focal plane D in front of
// it. With t its share of the way from the first to the last, in [-0.5, 0.5] (Looking Glass
// software, as public sources have it; none verified on hardware; of a part of the cone, t runs
// over that part):
//   webxr   D tan(depthiness cone t), t = (i + 0.5) / N - 0.5: each in the middle of its share
//   Core    D tan(depthiness cone t), t = i / (N - 1) - 0.5: the outermost at the cone's edges
//   Bridge  D depthiness tan(cone) t, t = i / (N - 1) - 0.5: at equal distances
// View 0 is the leftmost.
double quiltEye(const QuiltSpec& quilt, uint32_t view, double distance_m);

}  // namespace viewloom
