// SPDX-License-Identifier: Apache-2.0
// The lenses of a calibrated panel, over its px.
#pragma once

#include "calibration/calibration.h"
#include "shared/lenticular.h"

namespace viewloom {

// Lenses across the panel's width, along a row; negative where the pitch is.
double lensCount(const Calibration& calibration);
// How many widths of the panel a lens moves to the left from its bottom to its top; turned around
// with flip_x.
double lensTilt(const Calibration& calibration);

// Prepared in binary64; what a shader or a loop asks viewCoordinate() with.
abi::Lenticular makeLenticular(const Calibration& calibration);

}  // namespace viewloom
