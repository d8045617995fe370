// SPDX-License-Identifier: Apache-2.0
// Adjusts a panel's calibration by eye, on a test pattern that is made here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "base/status.h"
#include "calibration/calibration.h"

namespace viewloom::show {

struct TuneOptions {
  Calibration calibration;    // to begin with
  std::filesystem::path out;  // the file that is written
  std::optional<int> monitor;
  bool is_windowed = false;
};

struct TuneCallbacks {
  std::function<bool()> is_interrupted;
  std::function<void(const std::string&)> say;  // a line for the user
};

// Returns when the user has had it written, or ends it: then no file is touched. A file
// that cannot be written is said, and tuning goes on. Fails as openStage() does. Main thread.
absl::Status tunePanel(const TuneOptions& options, const TuneCallbacks& callbacks);

// Consequence of a key that changes a calibration while an eye judges the test pattern.
enum class TuneEffect { kNone, kRedraw, kWrite, kQuit };

// Up and down turn the pitch, left and right the slope, [ and ] the centre: 0.0005 lenses per inch,
// 0.001 and 0.002 lenses a key, ten times as much with is_coarse. Enter or s writes, escape or q
// ends. What would be no calibration any more is not done.
TuneEffect applyTuneKey(int32_t sdl_key, bool is_coarse, Calibration& calibration);

// The values and the keys, for the screen.
std::string describeTuning(const Calibration& calibration);

}  // namespace viewloom::show
