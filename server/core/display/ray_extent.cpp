// SPDX-License-Identifier: Apache-2.0
#include "display/ray_extent.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace viewloom {
namespace {

// Bounds of the eyes beside the view's own, m, and of the pixels beside the top left of a tile.
struct Box {
  glm::dvec2 low{0.0};
  glm::dvec2 high{0.0};
};

struct EyesAndPixels {
  Box eyes_m;
  Box px;
};

EyesAndPixels extentOf(const PinholeRays&, const AtlasLayout&) {
  VIEWLOOM_CHECK(false);
  return {};
}

EyesAndPixels extentOf(const LenticularRays& rays, const AtlasLayout& layout) {
  const double half_m = rays.distance_m * std::tan(rays.view_cone_rad / 2);
  return {.eyes_m = {.low = {-half_m, 0}, .high = {half_m, 0}},
          .px = {.high = {layout.size_px.width, layout.size_px.height}}};
}

EyesAndPixels extentOf(const MicrolensRays& rays, const AtlasLayout& layout) {
  const Camera& lens = layout.views.front().camera;
  const glm::dvec2 count(rays.columns, rays.rows);
  const double half_px = rays.lens_pitch_px / 2;
  // From the middle of the first and the last lens, through px as far as its edge.
  const glm::dvec2 first_m = (rays.first_px + half_px - rays.middle_px) * rays.m_per_px;
  const glm::dvec2 last_m = first_m + (count - 1.0) * rays.lens_pitch_px * rays.m_per_px;
  const glm::dvec2 leaning_m = half_px / lens.intrinsics.focal_px * rays.distance_m;
  return {.eyes_m = {.low = {first_m.x - leaning_m.x, -last_m.y - leaning_m.y},
                     .high = {last_m.x + leaning_m.x, -first_m.y + leaning_m.y}},
          .px = {.low = glm::dvec2(-half_px), .high = glm::dvec2(half_px)}};
}

}  // namespace

RayExtent rayExtent(const AtlasLayout& layout) {
  const Camera& view = layout.views.front().camera;
  EyesAndPixels extent =
      std::visit([&](const auto& rays) { return extentOf(rays, layout); }, layout.rays);
  glm::dvec2 beside_m(0.0);
  for (const RaySample& sample : layout.samples) {
    beside_m = glm::max(beside_m, glm::abs(sample.eye_m));
  }
  constexpr double kBeside_px = 0.5;  // samples stay within their px
  extent.px.low -= kBeside_px;
  const glm::dvec2 size_px = extent.px.high + kBeside_px - extent.px.low;
  RayExtent rays{.corners = {},
                 .size_px = {uint32_t(std::ceil(size_px.x)), uint32_t(std::ceil(size_px.y))}};
  const glm::dvec2 low_m = extent.eyes_m.low - beside_m;
  const glm::dvec2 high_m = extent.eyes_m.high + beside_m;
  for (const double x_m : {low_m.x, high_m.x}) {
    for (const double y_m : {low_m.y, high_m.y}) {
      rays.corners.push_back(
          sampledCamera(view, {.px = extent.px.low, .eye_m = {x_m, y_m}}, layout.eye_focus_m));
    }
  }
  return rays;
}

}  // namespace viewloom
