// SPDX-License-Identifier: Apache-2.0
#include "display/depth_budget.h"

#include <algorithm>
#include <cmath>

#include "display/display_kinds.h"

namespace viewloom {
namespace {

// Range of 1/Z, 1/m.
struct InvZStretch {
  double low = 0;
  double high = 0;

  double width() const { return high - low; }
  double middle() const { return (low + high) / 2; }
};

double pxCount(const DepthSpread& spread) {
  double count = 0;
  for (const DepthBin& bin : spread) count += bin.count;
  return count;
}

// The px of a bin are taken to lie evenly in it.
double shareOutside(const DepthSpread& spread, const InvZStretch& range) {
  double outside = 0;
  for (const DepthBin& bin : spread) {
    const double inside = std::min(bin.inv_z_high, range.high) - std::max(bin.inv_z_low, range.low);
    const double part = std::clamp(inside / (bin.inv_z_high - bin.inv_z_low), 0.0, 1.0);
    outside += bin.count * (1 - part);
  }
  return outside / pxCount(spread);
}

// The narrowest one, in whole bins, that holds the share.
InvZStretch narrowestRange(const DepthSpread& spread, double share) {
  const double wanted = share * pxCount(spread);
  InvZStretch narrowest{.low = spread.front().inv_z_low, .high = spread.back().inv_z_high};
  double inside = 0;
  size_t first = 0;
  for (const DepthBin& last : spread) {
    inside += last.count;
    for (; inside >= wanted; inside -= spread[first++].count) {
      const InvZStretch range{.low = spread[first].inv_z_low, .high = last.inv_z_high};
      if (range.width() < narrowest.width()) narrowest = range;
    }
  }
  return narrowest;
}

}  // namespace

double disparityPerInvZ(const AtlasLayout& layout) {
  const glm::dvec2 step = layout.views.front().camera.intrinsics.focal_px * layout.view_pitch_m;
  return std::max(step.x, step.y);
}

std::optional<DepthBudget> depthBudget(const AtlasLayout& layout, const SourceStats& stats,
                                       const DepthSpread& spread) {
  const double per_inv_z = disparityPerInvZ(layout);
  if (per_inv_z <= 0 || layout.eye_focus_m == kNoFocus_m || spread.empty()) return std::nullopt;
  // f_px pitch / Z is how far a surface moves, and the focal plane as far the other way.
  const double focus = 1 / layout.eye_focus_m;
  const auto shareBeyond = [&](double limit_px) {
    const double reach = limit_px / per_inv_z;
    return shareOutside(spread, {.low = focus - reach, .high = focus + reach});
  };
  const InvZStretch served = narrowestRange(spread, kServedShare);
  // Bins are wider than what is flat.
  const double middle = std::clamp(served.middle(), stats.inv_z_min, stats.inv_z_max);
  const double suggested_m = std::clamp(1 / middle, kFocalDistanceMin_m, kFocalDistanceMax_m);
  // The eyes of a cone stand on a line as much longer as the focal plane is further away. Tangents
  // grow faster than angles: a share of the cone is no more than that share of the line.
  const double served_px = per_inv_z * (suggested_m / layout.eye_focus_m) * served.width() / 2;
  return DepthBudget{
      .disparity_max_px = per_inv_z * std::max(std::abs(stats.inv_z_min - focus),
                                               std::abs(stats.inv_z_max - focus)),
      .beyond_fusing_share = shareBeyond(kFusingLimit_px),
      .beyond_ghosting_share = shareBeyond(kGhostingLimit_px),
      .suggested_focal_distance_m = suggested_m,
      .suggested_view_cone_rad = layout.view_cone_rad * std::min(1.0, kFusingLimit_px / served_px)};
}

}  // namespace viewloom
