// SPDX-License-Identifier: Apache-2.0
// One layer of a pattern while it is drawn: its picture, and where its surfaces lie.
#pragma once

#include <vector>

#include "patterns/canvas.h"
#include "synthetic/synthetic_frame.h"

namespace viewloom::patterns {

// Boxes of its surfaces are taken to whole px.
class LayerDrawing {
 public:
  // Without surface.
  LayerDrawing(SizePx size_px, const Rgb& color)
      : canvas_(size_px, color), depth_m_(size_px.area()) {}

  Canvas& canvas() { return canvas_; }

  // 1/Z is inv_z in the middle of the box, 1/m, and changes by the slopes with each px.
  struct Plane {
    double inv_z = 0;
    double slope_x = 0;
    double slope_y = 0;
  };
  void place(const PxBox& box, const Plane& plane);
  // Copies the other drawing there, surfaces too.
  void copy(const LayerDrawing& other, const PxBox& box);
  void clear(const PxBox& box);

  SyntheticLayer take();

 private:
  // visit(index of the px, x, y of its middle)
  template <typename Visit>
  void forEachPx(const PxBox& box, const Visit& visit) const;

  Canvas canvas_;
  std::vector<float> depth_m_;  // float[height][width]; 0 = nothing
};

}  // namespace viewloom::patterns
