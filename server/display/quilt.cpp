// SPDX-License-Identifier: Apache-2.0
#include "display/quilt.h"

#include <cmath>

#include "display/focal_window.h"

namespace viewloom {

SizePx quiltTileSize(const QuiltSpec& quilt) {
  return {quilt.size_px.width / quilt.columns, quilt.size_px.height / quilt.rows};
}

double quiltAspect(const QuiltSpec& quilt) {
  if (quilt.aspect > 0) return quilt.aspect;
  const SizePx tile = quiltTileSize(quilt);
  return double{1} * tile.width / tile.height;
}

std::vector<View> quiltViews(const QuiltSpec& quilt, const StreamDefaults& defaults) {
  const double distance_m = focalDistance(quilt.focal_distance_m, defaults);
  const FocalWindow window = focalWindow(distance_m, quilt.fov_y_rad, quiltAspect(quilt), defaults);
  std::vector<View> views;
  views.reserve(quilt.view_count);
  for (uint32_t i = 0; i < quilt.view_count; ++i) {
    const double angle_rad = quilt.view_cone_rad * ((i + 0.5) / quilt.view_count - 0.5);
    const double eye_x_m = distance_m * std::tan(angle_rad);
    views.push_back({cameraThroughWindow(window, eye_x_m, quiltTileSize(quilt))});
  }
  return views;
}

}  // namespace viewloom
