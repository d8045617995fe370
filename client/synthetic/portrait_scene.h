// SPDX-License-Identifier: Apache-2.0
// The scene for portrait displays: a mobile that turns at the opening of a painted box, with a
// board of letters and fine lines on the focal plane.
#pragma once

#include "synthetic/scene.h"

namespace viewloom::synthetic {

// A loop: the scene moves, slows down and stands, so that a viewer sees it sharp.
inline constexpr double kPortraitLoop_s = 20.0;
inline constexpr double kPortraitMoving_s = 15.0;
// Distance of the board and of the frame around the window, which lie on the focal plane.
inline constexpr double kPortraitFocus_m = 2.79;

// The same time in each loop gives the same scene; it moves smoothly.
Scene makePortraitScene(double time_s);

}  // namespace viewloom::synthetic
