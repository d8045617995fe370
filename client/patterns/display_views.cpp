// SPDX-License-Identifier: Apache-2.0
#include "patterns/display_views.h"

#include <algorithm>
#include <cmath>

namespace viewloom::patterns {

double DisplayViews::angle_rad(uint32_t view) const {
  return cone_rad * ((view + 0.5) / count - 0.5);
}

double DisplayViews::eyeTangent(uint32_t view) const {
  return std::tan(angle_rad(view));
}

double DisplayViews::focalPx(double source_focal_px, SizePx source_px) const {
  const double aspect = double{1} * size_px.width / size_px.height;
  const double shown_px = std::min<double>(source_px.width, source_px.height * aspect);
  return source_focal_px * size_px.width / shown_px;
}

}  // namespace viewloom::patterns
