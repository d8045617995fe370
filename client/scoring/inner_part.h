// SPDX-License-Identifier: Apache-2.0
// A picture without its border.
#pragma once

#include <cstdint>
#include <vector>

#include "scoring/image_score.h"

namespace viewloom {

struct InnerPart {
  uint32_t border_px = 0;  // twice it is less than both sides
  SizePx picture_px;

  SizePx sizePx() const {
    return {picture_px.width - 2 * border_px, picture_px.height - 2 * border_px};
  }
  // visit(index of the pixel in the picture), row by row.
  template <typename Visit>
  void forEach(Visit visit) const {
    for (size_t y = border_px; y < picture_px.height - border_px; ++y) {
      for (size_t x = border_px; x < picture_px.width - border_px; ++x) {
        visit(y * picture_px.width + x);
      }
    }
  }
};

inline ScoredImage cropped(const ScoredImage& image, const InnerPart& inner) {
  ScoredImage part = {.size_px = inner.sizePx(), .rgb = {}};
  part.rgb.reserve(3 * part.size_px.area());
  inner.forEach(
      [&](size_t i) { part.rgb.insert(part.rgb.end(), &image.rgb[3 * i], &image.rgb[3 * i] + 3); });
  return part;
}

template <typename Value>
std::vector<Value> cropped(const std::vector<Value>& plane, const InnerPart& inner) {
  std::vector<Value> part;
  part.reserve(inner.sizePx().area());
  inner.forEach([&](size_t i) { part.push_back(plane[i]); });
  return part;
}

}  // namespace viewloom
