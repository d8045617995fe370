// SPDX-License-Identifier: Apache-2.0
// Options that say which display to watch, and how its atlases come.
#pragma once

#include <string>

#include "base/status.h"
#include "cli/effect_options.h"
#include "cli/encoding_options.h"
#include "cli/rgbd_options.h"
#include "frame/size.h"
#include "usage/command_line.h"
#include "viewloom/v1/display.pb.h"

namespace viewloom::cli {

struct DisplayOptions {
  std::string file;    // or the message itself, as JSON; or a quilt from what follows
  std::string preset;  // of the quilt, the panel, or colour and depth
  uint32_t columns = 0;
  uint32_t rows = 0;
  SizePx size_px;
  double view_cone_deg = 0;
  double focal_distance_m = 0;
  double focus_following_s = 0;  // 0 = the focal plane stays
  double fov_y_deg = 0;
  bool is_native = false;        // the panel's own px
  std::string calibration_file;  // of the panel
  RgbdOptions rgbd;              // instead of all that
  TemporalOptions temporal;
  uint32_t sample_count = 1;
  LensOptions lens;
  uint32_t bounce_count = 0;  // of reflections; 0 = none
  EncodingOptions encoding;
};

// Options for the places and frames of its views, without their field of view.
usage::Option addDisplayShape(const usage::Command& app, DisplayOptions& options);
// Those options, and the rest of a request to a server.
void addDisplayOptions(const usage::Command& app, DisplayOptions& options);

// The px of the device itself instead of a quilt.
void addPanelOptions(const usage::Command& app, DisplayOptions& options);

// Whether a display was named at all.
bool isGiven(const DisplayOptions& options);
// Whether the display gives its own field of view, so that it needs none of a stream.
bool hasOwnFov(const DisplayOptions& options);
// Colour with depth instead of them; after the options that it excludes.
void addDepthDisplayOptions(const usage::Command& app, DisplayOptions& options);

absl::StatusOr<v1::Display> makeDisplay(const DisplayOptions& options);

}  // namespace viewloom::cli
