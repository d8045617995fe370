// SPDX-License-Identifier: Apache-2.0
// Reads the number that a view shows through the window of the test pattern view-numbers, as its
// description says, apart from what draws it.
#pragma once

#include <cstdint>
#include <optional>

#include "frame/size.h"
#include "patterns/canvas.h"

namespace viewloom::test {

// Nothing where the blocks make no number. `window` is in px of the source, which the view shows
// around its middle, so many times as large; is_white(x, y) is of a px of the view.
template <typename IsWhite>
std::optional<uint32_t> readViewNumber(const patterns::PxBox& window, SizePx source_px,
                                       SizePx view_px, double scale, const IsWhite& is_white) {
  const double side = 0.4 * window.width();
  const auto isWhite = [&](uint32_t row, uint32_t column) {
    const double x = window.middleX() + (column == 0 ? -0.5 : 0.5) * side;
    const double y = window.top + 3.3 * window.width() + (row + 0.5) * side;
    const auto viewPx = [&](double px, uint32_t source_side, uint32_t view_side) {
      return static_cast<uint32_t>((px - source_side / 2.0) * scale + view_side / 2.0);
    };
    return is_white(viewPx(x, source_px.width, view_px.width),
                    viewPx(y, source_px.height, view_px.height));
  };
  uint32_t number = 0, white_count = 0;
  for (uint32_t row = 1; row <= 5; ++row) {
    for (uint32_t column = 0; column < 2; ++column) {
      number = 2 * number + (isWhite(row, column) ? 1 : 0);
      white_count += isWhite(row, column) ? 1 : 0;
    }
  }
  const bool begins = isWhite(0, 0) && !isWhite(0, 1);
  const bool is_odd = white_count % 2 == 1;
  const bool ends = isWhite(6, 0) == is_odd && isWhite(6, 1) != is_odd;
  if (!begins || !ends) return std::nullopt;
  return number;
}

}  // namespace viewloom::test
