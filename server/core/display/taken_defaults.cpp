// SPDX-License-Identifier: Apache-2.0
#include "display/taken_defaults.h"

#include <algorithm>

#include "absl/strings/str_format.h"
#include "display/atlas_layout.h"

namespace viewloom {
namespace {

// Share of the nearest 1/Z, the least span that counts: anything is wider than a flat card.
constexpr double kSpanShareMin = 1.0 / 16;

bool hasSurfaces(const SourceStats& stats) {
  return stats.inv_z_near > 0;
}

bool isApart(double one, double other, double factor) {
  return one > factor * other || other > factor * one;
}

double spanOf(const SourceStats& stats) {
  return std::max(stats.inv_z_near - stats.inv_z_far, kSpanShareMin * stats.inv_z_near);
}

bool isTakenFromSame(const SourceStats& one, const SourceStats& other) {
  return one.inv_z_near == other.inv_z_near && one.inv_z_far == other.inv_z_far &&
         contentFocalDistance(one) == contentFocalDistance(other);
}

}  // namespace

bool hasDepthMoved(const SourceStats& from, const SourceStats& to, double factor) {
  if (!hasSurfaces(to)) return false;
  if (!hasSurfaces(from)) return true;
  return isApart(from.inv_z_near, to.inv_z_near, factor) ||
         isApart(contentFocalDistance(from), contentFocalDistance(to), factor) ||
         spanOf(to) > factor * spanOf(from);
}

std::string depthRangeText(const SourceStats& stats) {
  if (!hasSurfaces(stats)) return "no surface";
  const std::string near = absl::StrFormat("%.4g", 1 / stats.inv_z_near);
  if (stats.inv_z_far <= 0) return near + " m to infinity";
  return absl::StrFormat("%s to %.4g m", near, 1 / stats.inv_z_far);
}

bool TakenDefaults::follow(uint64_t session, const SourceStats& stats, int64_t built_ns) {
  const bool is_begun = isBegunBy(session, stats);
  session_ = session;
  if (is_begun) {
    factor_ = kMovedFactor;
    const bool is_first = taking_.count == 0;
    take(is_first ? DefaultsReason::kFirstFrame : DefaultsReason::kNewPublisher, stats, built_ns);
    return true;
  }
  if (built_ns - taken_ns_ >= kMoveRest_ns) factor_ = kMovedFactor;
  if (!hasDepthMoved(stats_, stats, factor_)) return false;
  factor_ *= factor_;
  take(DefaultsReason::kDepthMoved, stats, built_ns);
  return true;
}

bool TakenDefaults::isBegunBy(uint64_t session, const SourceStats& stats) const {
  if (taking_.count == 0) return true;
  return session != session_ && !isTakenFromSame(stats_, stats);
}

void TakenDefaults::take(DefaultsReason reason, const SourceStats& stats, int64_t built_ns) {
  stats_ = stats;
  taken_ns_ = built_ns;
  ++taking_.count;
  taking_.reason = reason;
}

}  // namespace viewloom
