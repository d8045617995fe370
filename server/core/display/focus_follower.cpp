// SPDX-License-Identifier: Apache-2.0
#include "display/focus_follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "display/depth_budget.h"

namespace viewloom {

std::optional<double> FocusFollower::follow(const AtlasLayout& layout,
                                            double suggested_focal_distance_m,
                                            double time_constant_s, int64_t time_ns) {
  const double laid_out = 1 / layout.focal_distance_m;
  const std::optional<int64_t> last_ns = std::exchange(time_ns_, time_ns);
  if (!last_ns) {
    inv_z_ = laid_out;
    return std::nullopt;
  }
  const double passed_s = 1e-9 * double(std::max(time_ns - *last_ns, int64_t{0}));
  inv_z_ += (1 / suggested_focal_distance_m - inv_z_) * -std::expm1(-passed_s / time_constant_s);
  if (disparityPerInvZ(layout) * std::abs(inv_z_ - laid_out) < kFocusStep_px) return std::nullopt;
  return std::clamp(1 / inv_z_, kFocalDistanceMin_m, kFocalDistanceMax_m);
}

}  // namespace viewloom
