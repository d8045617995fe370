// SPDX-License-Identifier: Apache-2.0
// Signs that near and far are swapped in the depth of a layer: what is above, around and inside
// what, and which of Z and 1/Z has straight floors and walls.
#pragma once

#include <string>

#include "inspect/depth_samples.h"
#include "inspect/measure_depth.h"

namespace viewloom::inspect {

// Sign that a depth plane is inside-out, as the subject of a sentence; "" without one. Each sign is
// enough: sky: a fifth of the top quarter has the nearest depth of all, but not of the bottom. rim:
// the top is nearer than the bottom, and the sides are nearer than the middle, by their medians and
// a tenth; skies, walls and floors lie the other way round. islands: two or more areas inside
// others are farther than these, and hardly any is nearer; things stand before a background, not
// behind holes of it. straight: floors and walls are straight in Z, though 1/Z is linear on planes.
std::string insideOutSign(const DepthSamples& samples, const DepthMeasures& measures);

}  // namespace viewloom::inspect
