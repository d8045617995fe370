// SPDX-License-Identifier: Apache-2.0
// Lenses of a calibrated panel, in terms of its pixels.
#pragma once

#include "calibration/calibration.h"
#include "shared/lenticular.h"

namespace viewloom {

// Number of lenses along a row of the panel; negative if the pitch is negative.
double lensCount(const Calibration& calibration);
// Widths of the panel by which a lens moves to the left from its bottom to its top; reversed with
// flip_x.
double lensTilt(const Calibration& calibration);

// Values for viewCoordinate() in shaders and loops, computed in binary64.
abi::Lenticular makeLenticular(const Calibration& calibration);

}  // namespace viewloom
