// SPDX-License-Identifier: Apache-2.0
// How far neighbouring views of a display move what they show, and how it could be less.
#pragma once

#include <optional>

#include "display/atlas_layout.h"
#include "frame/depth_spread.h"

namespace viewloom {

// Of surfaces that move further from view to view than this, the two views that an eye sees at a
// time no longer fuse: 4 to 5 px are what panels are known to stand.
inline constexpr double kFusingLimit_px = 5;
// Further than this, they show beside each other.
inline constexpr double kGhostingLimit_px = 8;
// What a suggestion is for: the share of px in the narrowest range of 1/Z that holds so many.
inline constexpr double kServedShare = 0.98;

// As proto viewloom.v1.DepthBudget.
struct DepthBudget {
  double disparity_max_px = 0;
  double beyond_fusing_share = 0;    // 0..1
  double beyond_ghosting_share = 0;  // 0..1
  double suggested_focal_distance_m = 0;
  double suggested_view_cone_rad = 0;  // up to the display's own; 0 = it has none
};

// Of a surface, for each 1/m that its 1/Z lies beside the focal plane's: px from a view to its
// neighbour, beside or above it.
double disparityPerInvZ(const AtlasLayout& layout);

// Of a source with these stats and this spread. None where no views are neighbours on one focal
// plane, and of a source without surface.
std::optional<DepthBudget> depthBudget(const AtlasLayout& layout, const SourceStats& stats,
                                       const DepthSpread& spread);

}  // namespace viewloom
