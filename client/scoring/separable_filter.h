// SPDX-License-Identifier: Apache-2.0
// Weighted sums over the rows and columns of a plane.
#pragma once

#include <span>
#include <vector>

#include "frame/size.h"

namespace viewloom {

// plane: float[height][width]. across, down: weights along rows and along columns, of odd length,
// the middle one for the pixel itself. Beyond an edge of the image stands the sample at the edge.
std::vector<float> filtered(std::span<const float> plane, SizePx size_px,
                            std::span<const float> across, std::span<const float> down);

}  // namespace viewloom
