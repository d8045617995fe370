// SPDX-License-Identifier: Apache-2.0
#include "patterns/canvas.h"

#include <algorithm>
#include <cmath>

#include "base/srgb.h"

namespace viewloom::patterns {
namespace {

constexpr size_t kBytesPerPx = 4;

double linearFrom(uint8_t code) {
  return linearFromSrgb(code / 255.0);
}

uint8_t codeFrom(double linear) {
  return static_cast<uint8_t>(std::lround(255 * std::clamp(srgbFromLinear(linear), 0.0, 1.0)));
}

// Length of [px, px + 1) within the range.
double overlap(double low, double high, double px) {
  return std::clamp(std::min(high, px + 1) - std::max(low, px), 0.0, 1.0);
}

// Share of a pixel that is so far inside an edge, px.
double shareInside(double distance_px) {
  return std::clamp(distance_px + 0.5, 0.0, 1.0);
}

uint32_t wholePx(double px, uint32_t side_px) {
  return static_cast<uint32_t>(std::clamp(px, 0.0, static_cast<double>(side_px)));
}

}  // namespace

PxBox boxAround(double middle_x, double middle_y, double width, double height) {
  return {.left = middle_x - width / 2,
          .top = middle_y - height / 2,
          .right = middle_x + width / 2,
          .bottom = middle_y + height / 2};
}

PxBox intersection(const PxBox& a, const PxBox& b) {
  PxBox both{
      .left = std::max(a.left, b.left), .top = std::max(a.top, b.top), .right = 0, .bottom = 0};
  both.right = std::max(both.left, std::min(a.right, b.right));
  both.bottom = std::max(both.top, std::min(a.bottom, b.bottom));
  return both;
}

Canvas::Canvas(SizePx size_px, const Rgb& color) : size_px_(size_px) {
  rgba_.reserve(kBytesPerPx * size_px.area());
  for (uint64_t i = 0; i < size_px.area(); ++i) {
    rgba_.insert(rgba_.end(), {color[0], color[1], color[2], 255});
  }
}

void Canvas::blend(uint32_t x, uint32_t y, double share, const Rgb& color) {
  uint8_t* const px = &rgba_[kBytesPerPx * (size_t{y} * size_px_.width + x)];
  for (size_t i = 0; i < color.size() && share > 0; ++i) {
    px[i] = share >= 1 ? color[i]
                       : codeFrom((1 - share) * linearFrom(px[i]) + share * linearFrom(color[i]));
  }
}

template <typename ShareAt>
void Canvas::blendBox(const PxBox& box, const Rgb& color, const ShareAt& share_at) {
  const uint32_t right = wholePx(std::ceil(box.right), size_px_.width);
  const uint32_t bottom = wholePx(std::ceil(box.bottom), size_px_.height);
  for (uint32_t y = wholePx(std::floor(box.top), size_px_.height); y < bottom; ++y) {
    for (uint32_t x = wholePx(std::floor(box.left), size_px_.width); x < right; ++x) {
      blend(x, y, share_at(x, y), color);
    }
  }
}

void Canvas::fill(const PxBox& box, const Rgb& color) {
  blendBox(box, color, [&](double x, double y) {
    return overlap(box.left, box.right, x) * overlap(box.top, box.bottom, y);
  });
}

void Canvas::frame(const PxBox& box, double line_px, const Rgb& color) {
  const PxBox inside{.left = box.left + line_px,
                     .top = box.top + line_px,
                     .right = box.right - line_px,
                     .bottom = box.bottom - line_px};
  fill({.left = box.left, .top = box.top, .right = box.right, .bottom = inside.top}, color);
  fill({.left = box.left, .top = inside.bottom, .right = box.right, .bottom = box.bottom}, color);
  fill({.left = box.left, .top = inside.top, .right = inside.left, .bottom = inside.bottom}, color);
  fill({.left = inside.right, .top = inside.top, .right = box.right, .bottom = inside.bottom},
       color);
}

void Canvas::ring(double middle_x, double middle_y, double radius_px, double line_px,
                  const Rgb& color) {
  const double side_px = 2 * radius_px + line_px + 2;
  blendBox(boxAround(middle_x, middle_y, side_px, side_px), color, [&](double x, double y) {
    const double distance = std::hypot(x + 0.5 - middle_x, y + 0.5 - middle_y);
    return shareInside(line_px / 2 - std::abs(distance - radius_px));
  });
}

void Canvas::line(double from_x, double from_y, double to_x, double to_y, double line_px,
                  const Rgb& color) {
  const double length = std::hypot(to_x - from_x, to_y - from_y);
  const double along_x = (to_x - from_x) / length, along_y = (to_y - from_y) / length;
  const PxBox box{.left = std::min(from_x, to_x) - line_px,
                  .top = std::min(from_y, to_y) - line_px,
                  .right = std::max(from_x, to_x) + line_px,
                  .bottom = std::max(from_y, to_y) + line_px};
  blendBox(box, color, [&](double x, double y) {
    const double dx = x + 0.5 - from_x, dy = y + 0.5 - from_y;
    const double way = dx * along_x + dy * along_y;
    const double beside = std::abs(dx * along_y - dy * along_x);
    return shareInside(std::min(way, length - way)) * shareInside(line_px / 2 - beside);
  });
}

void Canvas::write(const WrittenText& text, TextAnchor anchor, double x, double y,
                   const Rgb& color) {
  const double share = anchor == TextAnchor::kLeft ? 0 : anchor == TextAnchor::kMiddle ? 0.5 : 1;
  // Letters stay on whole px, as they were made for.
  place(text, std::llround(x - share * text.size_px.width),
        std::llround(y - text.size_px.height / 2.0), false, color);
}

void Canvas::writeUpwards(const WrittenText& text, double middle_x, double middle_y,
                          const Rgb& color) {
  place(text, std::llround(middle_x - text.size_px.height / 2.0),
        std::llround(middle_y - text.size_px.width / 2.0), true, color);
}

void Canvas::copyPx(const Canvas& other, size_t px) {
  std::copy_n(&other.rgba_[kBytesPerPx * px], kBytesPerPx, &rgba_[kBytesPerPx * px]);
}

void Canvas::place(const WrittenText& text, int64_t left, int64_t top, bool is_upwards,
                   const Rgb& color) {
  for (uint32_t row = 0; row < text.size_px.height; ++row) {
    for (uint32_t column = 0; column < text.size_px.width; ++column) {
      const int64_t x = left + (is_upwards ? row : column);
      const int64_t y = top + (is_upwards ? text.size_px.width - 1 - column : row);
      if (x < 0 || y < 0 || x >= size_px_.width || y >= size_px_.height) continue;
      const uint8_t coverage = text.coverage[size_t{row} * text.size_px.width + column];
      blend(static_cast<uint32_t>(x), static_cast<uint32_t>(y), coverage / 255.0, color);
    }
  }
}

}  // namespace viewloom::patterns
