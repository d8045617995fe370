// SPDX-License-Identifier: Apache-2.0
// The monitors of this machine, and which of them is meant.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "frame/size.h"

namespace viewloom::show {

struct Monitor {
  int number = 0;  // as the window system counts, from 0
  std::string name;
  SizePx size_px;  // of its present resolution
};

// Needs SdlVideo. Main thread.
std::vector<Monitor> listMonitors();

// "0: DELL U2412M (1920x1200), 1: LKG-P (1536x2048)".
std::string describeMonitors(std::span<const Monitor> monitors);

struct MonitorChoice {
  std::optional<int> number;       // what the user said
  std::optional<SizePx> panel_px;  // the calibrated panel, if there is one
  bool is_windowed = false;        // any monitor will do
};

// INVALID_ARGUMENT lists those there are: when the number is none of theirs, or no number was said
// and none has the panel's size.
absl::StatusOr<Monitor> chooseMonitor(std::span<const Monitor> monitors,
                                      const MonitorChoice& choice);

// INVALID_ARGUMENT when a px of the window is no px of the panel: scaled, or another resolution.
absl::Status checkNativePixels(SizePx window_px, SizePx panel_px);

}  // namespace viewloom::show
