// SPDX-License-Identifier: Apache-2.0
// Options for the effects of a display.
#pragma once

#include <optional>

#include "usage/command_line.h"
#include "viewloom/v1/display.pb.h"

namespace viewloom::cli {

// A lens before every view.
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

// Atlases between the frames of a stream.
struct TemporalOptions {
  double output_rate_hz = 0;  // 0 = an atlas a frame
  v1::TemporalMode mode = v1::TEMPORAL_MODE_UNSPECIFIED;
  double bridge_s = 0;
};

// None of them beside `file`, which says it all.
void addTemporalOptions(const usage::Command& app, TemporalOptions& options, usage::Option file);

// Nothing is set without a rate.
void setTemporal(const TemporalOptions& options, v1::Display& display);

}  // namespace viewloom::cli
