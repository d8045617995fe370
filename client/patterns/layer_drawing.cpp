// SPDX-License-Identifier: Apache-2.0
#include "patterns/layer_drawing.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace viewloom::patterns {
namespace {

// Those whose middle lies behind it.
uint32_t firstPx(double edge, uint32_t side_px) {
  return static_cast<uint32_t>(
      std::clamp(std::floor(edge + 0.5), 0.0, static_cast<double>(side_px)));
}

}  // namespace

template <typename Visit>
void LayerDrawing::forEachPx(const PxBox& box, const Visit& visit) const {
  const SizePx size_px = canvas_.sizePx();
  const uint32_t right = firstPx(box.right, size_px.width);
  const uint32_t bottom = firstPx(box.bottom, size_px.height);
  for (uint32_t y = firstPx(box.top, size_px.height); y < bottom; ++y) {
    for (uint32_t x = firstPx(box.left, size_px.width); x < right; ++x) {
      visit(size_t{y} * size_px.width + x, x + 0.5, y + 0.5);
    }
  }
}

void LayerDrawing::place(const PxBox& box, const Plane& plane) {
  forEachPx(box, [&](size_t px, double x, double y) {
    const double inv_z =
        plane.inv_z + plane.slope_x * (x - box.middleX()) + plane.slope_y * (y - box.middleY());
    depth_m_[px] = static_cast<float>(1 / inv_z);
  });
}

void LayerDrawing::copy(const LayerDrawing& other, const PxBox& box) {
  forEachPx(box, [&](size_t px, double /*x*/, double /*y*/) {
    depth_m_[px] = other.depth_m_[px];
    canvas_.copyPx(other.canvas_, px);
  });
}

void LayerDrawing::clear(const PxBox& box) {
  forEachPx(box, [&](size_t px, double /*x*/, double /*y*/) { depth_m_[px] = 0; });
}

SyntheticLayer LayerDrawing::take() {
  return {.color = canvas_.take(), .depth_m = std::move(depth_m_)};
}

}  // namespace viewloom::patterns
