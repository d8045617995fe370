// SPDX-License-Identifier: Apache-2.0
#include "display/source_demand.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "display/ray_extent.h"
#include "frame/limits.h"

namespace viewloom {
namespace {

// Tangent of the widest half angle a pinhole can serve, that of 2.6 rad: what looks further to the
// side, or back, asks for this much.
const double kTangentMax = std::tan(kViewAngleMax_rad / 2);
// Products of tangents and focal lengths are whole px up to this.
constexpr double kRounding_px = 1e-6;

uint32_t sidePx(double focal_px, double tangent_extent) {
  const double most_px = FrameLimits{}.plane_side_px_max;
  const double side_px = std::ceil(focal_px * tangent_extent - kRounding_px);
  return side_px > 1 ? static_cast<uint32_t>(std::min(side_px, most_px)) : 1;
}

}  // namespace

const InvZRange& SettledRange::settle(const InvZRange& measured) {
  const double margin = kMargin * measured.near;
  const bool stays = settled_.far <= measured.far && settled_.near >= measured.near &&
                     settled_.far >= measured.far - 2 * margin &&
                     settled_.near <= measured.near + 2 * margin;
  if (!stays) {
    settled_ = {.far = std::max(measured.far - margin, 0.0), .near = measured.near + margin};
  }
  return settled_;
}

OutermostViews outermostViewsOf(const AtlasLayout& layout, const View& view) {
  if (!std::holds_alternative<PinholeRays>(layout.rays)) {
    RayExtent extent = rayExtent(layout);
    return {.cameras = std::move(extent.corners), .size_px = extent.size_px};
  }
  glm::dvec2 beside_m(0.0);
  for (const RaySample& sample : layout.samples) {
    beside_m = glm::max(beside_m, glm::abs(sample.eye_m));
  }
  OutermostViews views{.cameras = {}, .size_px = layout.tile_size_px};
  if (beside_m == glm::dvec2(0.0)) {
    views.cameras = {view.camera};
    return views;
  }
  for (const glm::dvec2 corner : {glm::dvec2(-1, -1), {-1, 1}, {1, -1}, {1, 1}}) {
    views.cameras.push_back(
        sampledCamera(view.camera, {.eye_m = corner * beside_m}, layout.focusOf(view)));
  }
  return views;
}

OutermostViews outermostViews(const AtlasLayout& layout) {
  OutermostViews views{.cameras = {}, .size_px = {}};
  for (const View& view : layout.views) {
    const OutermostViews own = outermostViewsOf(layout, view);
    views.cameras.insert(views.cameras.end(), own.cameras.begin(), own.cameras.end());
    views.size_px = own.size_px;
  }
  return views;
}

void SourceDemand::include(const OutermostViews& views, const Pose& source_from_display,
                           const InvZRange& range) {
  for (const Camera& view : views.cameras) {
    include({.pose = compose(source_from_display, view.pose), .intrinsics = view.intrinsics},
            views.size_px, range);
  }
}

void SourceDemand::include(const Camera& view, SizePx size_px, const InvZRange& range) {
  const Fov fov = fovFromIntrinsics(view.intrinsics, size_px);
  // The part of space that a view sees between two planes is convex, so its corners bound its
  // picture.
  for (const double x : {std::tan(fov.left_rad), std::tan(fov.right_rad)}) {
    for (const double y : {std::tan(fov.down_rad), std::tan(fov.up_rad)}) {
      for (const double inv_z : {range.far, range.near}) includeCorner(view, {x, y}, inv_z);
    }
  }
  has_parallax_ = has_parallax_ || view.pose.position_m != glm::dvec3(0.0);
}

// Lengths are times inv_z: what lies at that depth is 1 away from the source, infinity too.
void SourceDemand::includeCorner(const Camera& view, glm::dvec2 tangents, double inv_z) {
  const glm::dvec3 direction = view.pose.orientation * glm::dvec3(tangents, -1);
  const glm::dvec3 eye = view.pose.position_m * inv_z;
  const double ahead = -direction.z;
  if (ahead <= 0) {  // never comes to that depth
    includeTangents(
        {std::copysign(kTangentMax, direction.x), std::copysign(kTangentMax, direction.y)});
    return;
  }
  // From the eye to the depth; a view beyond it begins where it stands.
  const double way = std::max((1 + eye.z) / ahead, 0.0);
  const glm::dvec3 point = eye + way * direction;
  const glm::dvec2 seen = glm::dvec2(point) / -point.z;
  includeTangents(seen);
  if (way == 0 || std::max(std::abs(seen.x), std::abs(seen.y)) > kTangentMax) return;
  // How far the view's picture of a point moves with the point's tangents: u = f q.x / -q.z at
  // q = way (x, y, -1), so du = f (dq.x + x dq.z) / way, and likewise of v.
  for (int axis = 0; axis < 2; ++axis) {
    glm::dvec3 step(0.0);
    step[axis] = 1;
    const glm::dvec3 moved = glm::conjugate(view.pose.orientation) * step;
    const glm::dvec2 moved_px =
        view.intrinsics.focal_px * (glm::dvec2(moved) + tangents * moved.z) / way;
    focal_px_[axis] = std::max(focal_px_[axis], glm::length(moved_px));
  }
}

void SourceDemand::includeTangents(glm::dvec2 tangents) {
  const glm::dvec2 served = glm::clamp(tangents, -kTangentMax, kTangentMax);
  left_ = std::min(left_, served.x);
  right_ = std::max(right_, served.x);
  down_ = std::min(down_, served.y);
  up_ = std::max(up_, served.y);
}

Fov SourceDemand::fov() const {
  return {.left_rad = std::atan(left_),
          .right_rad = std::atan(right_),
          .up_rad = std::atan(up_),
          .down_rad = std::atan(down_)};
}

SizePx SourceDemand::sizePx() const {
  return {sidePx(focal_px_.x, right_ - left_), sidePx(focal_px_.y, up_ - down_)};
}

}  // namespace viewloom
