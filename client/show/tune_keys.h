// SPDX-License-Identifier: Apache-2.0
// What keys change about a calibration while an eye judges the test pattern.
#pragma once

#include <cstdint>
#include <string>

#include "calibration/calibration.h"

namespace viewloom::show {

enum class TuneEffect { kNone, kRedraw, kWrite, kQuit };

// Up and down turn the pitch, left and right the slope, [ and ] the centre: 0.0005 lenses per inch,
// 0.001 and 0.002 lenses a key, ten times as much with is_coarse. Enter or s writes, escape or q
// ends. What would be no calibration any more is not done.
TuneEffect applyTuneKey(int32_t sdl_key, bool is_coarse, Calibration& calibration);

// The values and the keys, for the screen.
std::string describeTuning(const Calibration& calibration);

}  // namespace viewloom::show
