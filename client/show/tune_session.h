// SPDX-License-Identifier: Apache-2.0
// Adjusts a panel's calibration by eye, on a test pattern that is made here.
#pragma once

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

}  // namespace viewloom::show
