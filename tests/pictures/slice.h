// SPDX-License-Identifier: Apache-2.0
// A drawing of the row that the pictures cut through: x to the right, 1/Z upwards.
#pragma once

#include <string_view>

#include "pictures/svg.h"

namespace viewloom::pictures {

class Slice {
 public:
  // With axes, and a heading; `strip_count` rows of px have room below.
  explicit Slice(std::string_view heading, int strip_count = 0);

  // Point for a place in the source, px and 1/m.
  Point at(double x_px, double inv_z) const;
  // Whether it lies between the first and the last column drawn.
  bool shows(double x_px) const;
  // The part of a line that lies between them; styles as in svg.cpp.
  void line(double from_px, double from_inv_z, double to_px, double to_inv_z,
            std::string_view style);
  // A note below all else.
  void note(std::string_view words);
  // The upper left corner of a px of a view, in a row of them, and its size.
  Point stripAt(int strip, double x_px) const;
  static double stripPx();
  // Names the content of a strip.
  void nameStrip(int strip, std::string_view words);

  Svg& svg() { return svg_; }

 private:
  Svg svg_;
  int strip_count_;
};

// The style of what belongs to a layer.
std::string ofLayer(std::string_view style, int layer);

}  // namespace viewloom::pictures
