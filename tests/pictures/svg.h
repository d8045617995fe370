// SPDX-License-Identifier: Apache-2.0
// A drawing as an SVG file, and whether two of them show the same.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace viewloom::pictures {

// Px of the drawing, y down.
struct Point {
  double x = 0;
  double y = 0;
};

// Shapes in the order in which they are added; `style` names one of the classes in svg.cpp.
class Svg {
 public:
  Svg(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {}

  void line(Point from, Point to, std::string_view style);
  void circle(Point center, double radius_px, std::string_view style);
  // `fill`: #rrggbb, or empty: that of the style.
  void box(Point corner, double box_width_px, double box_height_px, std::string_view style,
           std::string_view fill = {});
  void text(Point at, std::string_view words, std::string_view style);

  std::string file() const;

 private:
  int width_px_;
  int height_px_;
  std::string shapes_;
};

// Whether two files differ by no more than rounding: equal but for numbers, and those by no more
// than this, px of the drawing (or visits, where they are written down).
bool showTheSame(std::string_view a, std::string_view b, double tolerance);

}  // namespace viewloom::pictures
