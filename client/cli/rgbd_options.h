// SPDX-License-Identifier: Apache-2.0
// Options for displays that make their own views: colour with depth instead of a quilt.
#pragma once

#include "frame/size.h"
#include "usage/command_line.h"
#include "viewloom/v1/display.pb.h"

namespace viewloom::cli {

struct RgbdOptions {
  SizePx view_size_px;  // without width: another kind of display
  v1::RgbdForm form = v1::RGBD_FORM_UNSPECIFIED;
  v1::DepthPlacement placement = v1::DEPTH_PLACEMENT_UNSPECIFIED;
  uint32_t depth_bits = 8;
  bool is_black_near = false;
  double near_m = 0;
  double far_m = 0;
  double screen_m = 0;
};

// None of them beside `others`.
void addRgbdOptions(const usage::Command& app, RgbdOptions& options,
                    const std::vector<usage::Option>& others);

v1::RgbdDisplay makeRgbd(const RgbdOptions& options, double fov_y_rad);

}  // namespace viewloom::cli
