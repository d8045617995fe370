// SPDX-License-Identifier: Apache-2.0
#include "display/views_outside.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace viewloom {
namespace {

constexpr double kHundredth = 0.01;

// Distance of a point from the source's image, px; positive: outside.
double shareBeside(glm::dvec2 point_px, SizePx size_px) {
  const glm::dvec2 size(size_px.width, size_px.height);
  const glm::dvec2 beside = glm::max(-point_px, point_px - size);
  const glm::dvec2 counted(beside.x < kOutsideTolerance_px ? std::min(beside.x, 0.0) : beside.x,
                           beside.y < kOutsideTolerance_px ? std::min(beside.y, 0.0) : beside.y);
  return std::min(std::max(counted.x / size.x, counted.y / size.y), 1.0);
}

// Where the source has what a view sees at these tangents, at 1/Z. Lengths are times inv_z, so that
// infinity is as near as anything.
double shareOfRay(const Camera& view, glm::dvec2 tangents, double inv_z, const Intrinsics& source,
                  SizePx source_px) {
  const glm::dvec3 direction = view.pose.orientation * glm::dvec3(tangents, -1);
  const glm::dvec3 eye = view.pose.position_m * inv_z;
  if (direction.z >= 0) return 1;  // never comes to that depth
  const glm::dvec3 point = eye + std::max((1 + eye.z) / -direction.z, 0.0) * direction;
  const glm::dvec2 seen = glm::dvec2(point.x, -point.y) / -point.z;
  return shareBeside(source.focal_px * seen + source.principal_px, source_px);
}

double shareOfView(const Camera& view, SizePx view_px, const Intrinsics& source, SizePx source_px,
                   const InvZRange& range) {
  // On a plane, a view sees the area between its corners.
  const glm::dvec2 size(view_px.width, view_px.height);
  double share = -1;
  for (const glm::dvec2 corner : {glm::dvec2(0, 0), {size.x, 0.0}, {0.0, size.y}, size}) {
    const glm::dvec2 beside = (corner - view.intrinsics.principal_px) / view.intrinsics.focal_px;
    for (const double inv_z : {range.far, range.near}) {
      share = std::max(share, shareOfRay(view, {beside.x, -beside.y}, inv_z, source, source_px));
    }
  }
  return share;
}

}  // namespace

std::vector<double> outsideShares(const AtlasLayout& layout, const Pose& source_from_display,
                                  const Intrinsics& source, SizePx source_px,
                                  const InvZRange& range) {
  std::vector<double> shares;
  shares.reserve(layout.views.size());
  for (const View& view : layout.views) {
    const OutermostViews outermost = outermostViewsOf(layout, view);
    double share = -1;
    for (Camera camera : outermost.cameras) {
      camera.pose = compose(source_from_display, camera.pose);
      share = std::max(share, shareOfView(camera, outermost.size_px, source, source_px, range));
    }
    shares.push_back(share);
  }
  return shares;
}

std::vector<ViewsOutside> viewsOutside(std::span<const double> shares) {
  std::vector<ViewsOutside> runs;
  for (uint32_t view = 0; view < shares.size(); ++view) {
    if (shares[view] <= 0) continue;
    if (runs.empty() || runs.back().last_view + 1 != view) runs.push_back({.first_view = view});
    runs.back().last_view = view;
    runs.back().share = std::max(runs.back().share, shares[view]);
  }
  return runs;
}

std::vector<ViewsOutside> SettledShares::settle(std::span<const double> shares) {
  settled_.resize(shares.size(), 0.0);
  for (size_t view = 0; view < shares.size(); ++view) {
    double& settled = settled_[view];
    const bool stays = settled > 0 ? shares[view] > settled - kHundredth - kTremble &&
                                         shares[view] <= settled + kTremble
                                   : shares[view] <= 0;
    if (!stays) settled = std::max(std::ceil(shares[view] / kHundredth), 0.0) * kHundredth;
  }
  return viewsOutside(settled_);
}

}  // namespace viewloom
