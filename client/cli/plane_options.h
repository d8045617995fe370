// SPDX-License-Identifier: Apache-2.0
// Options that say what the samples of files mean, and which camera took them.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include "viewloom/v1/frame.pb.h"
#include "viewloom/v1/manifest.pb.h"

namespace viewloom::cli {

struct PlaneOptions {
  std::string depth_meaning = "planar";
  v1::DepthFormat depth;  // all but the meaning
  std::optional<double> depth_invalid;
  bool depth_far_zero = false;
  std::string transfer;  // "" = by the file
  std::string alpha;     // "" = by the file
  double fov_y_deg = 40;
  double focal_px = 0;               // 0 = from fov_y_deg
  std::vector<double> principal_px;  // none = the middle
  double connection_tolerance = 0;
};

void addPlaneOptions(CLI::App& app, PlaneOptions& options);

v1::DepthFormat depthFormat(const PlaneOptions& options);
void setColorMeaning(const PlaneOptions& options, v1::PlaneFile& color);
// For a depth plane of this size.
v1::Camera camera(const PlaneOptions& options, const v1::SizePx& size);

}  // namespace viewloom::cli
