// SPDX-License-Identifier: Apache-2.0
// Options for a lens before the views of a display.
#pragma once

#include <optional>

#include "usage/command_line.h"
#include "viewloom/v1/display.pb.h"

namespace viewloom::cli {

struct LensOptions {
  double aperture_radius_m = 0;  // 0 = everything is sharp
  bool has_automatic_aperture = false;
  std::optional<double> focus_distance_m;
  uint32_t blades = 0;
  uint32_t walked_count = 0;
  std::optional<uint32_t> gathered_count;
  v1::GatherMode mode = v1::GATHER_MODE_UNSPECIFIED;
  v1::Quality quality = v1::QUALITY_UNSPECIFIED;
};

// None of them beside `file`, which says it all.
void addLensOptions(const usage::Command& app, LensOptions& options, usage::Option file);

// No lens without an aperture.
void setLens(const LensOptions& options, v1::Display& display);

}  // namespace viewloom::cli
