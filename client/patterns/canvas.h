// SPDX-License-Identifier: Apache-2.0
// A picture to draw shapes and letters on, smooth at their edges.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "frame/size.h"
#include "text/font.h"

namespace viewloom::patterns {

using Rgb = std::array<uint8_t, 3>;  // sRGB

// px from the top left corner of the picture; right and bottom are behind the last.
struct PxBox {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;

  double width() const { return right - left; }
  double height() const { return bottom - top; }
  double middleX() const { return (left + right) / 2; }
  double middleY() const { return (top + bottom) / 2; }
};

PxBox boxAround(double middle_x, double middle_y, double width, double height);
PxBox intersection(const PxBox& a, const PxBox& b);

// Where a text stands: its own left edge, middle or right edge at x, the middle of its lines at y.
enum class TextAnchor : uint8_t { kLeft, kMiddle, kRight };

// Shapes cover what of a px lies in them, blended as light; a shape whose edges are on whole px
// has exactly its colour. What lies beside the picture is left out.
class Canvas {
 public:
  Canvas(SizePx size_px, const Rgb& color);

  void fill(const PxBox& box, const Rgb& color);
  // A frame of line_px inside the box.
  void frame(const PxBox& box, double line_px, const Rgb& color);
  void ring(double middle_x, double middle_y, double radius_px, double line_px, const Rgb& color);
  void line(double from_x, double from_y, double to_x, double to_y, double line_px,
            const Rgb& color);
  void write(const WrittenText& text, TextAnchor anchor, double x, double y, const Rgb& color);
  // Turned to the left: it reads upwards. Around its middle.
  void writeUpwards(const WrittenText& text, double middle_x, double middle_y, const Rgb& color);
  // The same px of a picture of the same size; px: y * width + x.
  void copyPx(const Canvas& other, size_t px);

  SizePx sizePx() const { return size_px_; }
  // uint8_t[height][width][4], opaque, top row first.
  const std::vector<uint8_t>& rgba() const { return rgba_; }
  std::vector<uint8_t> take() { return std::move(rgba_); }

 private:
  void blend(uint32_t x, uint32_t y, double share, const Rgb& color);
  // shareAt(x, y) of the px there, of those that touch the box.
  template <typename ShareAt>
  void blendBox(const PxBox& box, const Rgb& color, const ShareAt& share_at);
  void place(const WrittenText& text, int64_t left, int64_t top, bool is_upwards, const Rgb& color);

  SizePx size_px_;
  std::vector<uint8_t> rgba_;
};

}  // namespace viewloom::patterns
