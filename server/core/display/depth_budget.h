// SPDX-License-Identifier: Apache-2.0
// Disparity between neighbouring views of a display, and a layout with less of it.
#pragma once

#include <optional>

#include "display/atlas_layout.h"
#include "frame/depth_spread.h"

namespace viewloom {

// Largest disparity at which the two views that an eye sees at a time still fuse. Panels are known
// to bear 4 to 5 px.
inline constexpr double kFusingLimit_px = 5;
// Largest disparity before the two views show beside each other.
inline constexpr double kGhostingLimit_px = 8;
// Share of pixels that a suggestion serves: those in the narrowest range of 1/Z that holds so many.
inline constexpr double kServedShare = 0.98;

// See proto viewloom.v1.DepthBudget.
struct DepthBudget {
  double disparity_max_px = 0;
  double beyond_fusing_share = 0;    // 0..1
  double beyond_ghosting_share = 0;  // 0..1
  double suggested_focal_distance_m = 0;
  double suggested_view_cone_rad = 0;  // at most the display's own; 0 = no cone
};

// Disparity of a surface from a view to its neighbour beside or above it, px for each 1/m between
// its 1/Z and that of the focal plane.
double disparityPerInvZ(const AtlasLayout& layout);

// Budget for a source with these stats and this spread. Empty if no views are neighbours on one
// focal plane, or if the source has no surface.
std::optional<DepthBudget> depthBudget(const AtlasLayout& layout, const SourceStats& stats,
                                       const DepthSpread& spread);

}  // namespace viewloom
