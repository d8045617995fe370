// SPDX-License-Identifier: Apache-2.0
#include "inputs/exr_windows.h"

#include <algorithm>

#include "base/str_cat.h"
#include "files/plane_image.h"

namespace viewloom::inputs {
namespace {

using files::ExrWindow;

std::string textOf(const ExrWindow& window) {
  return strCat(window.width(), "x", window.height(), " px from ", window.min_x, ", ",
                window.min_y);
}

bool isInside(const ExrWindow& inner, const ExrWindow& outer) {
  return isSame(intersection(inner, outer), inner);
}

}  // namespace

ExrWindow intersection(const ExrWindow& a, const ExrWindow& b) {
  return {std::max(a.min_x, b.min_x), std::max(a.min_y, b.min_y), std::min(a.max_x, b.max_x),
          std::min(a.max_y, b.max_y)};
}

bool isSame(const ExrWindow& a, const ExrWindow& b) {
  return a.min_x == b.min_x && a.min_y == b.min_y && a.max_x == b.max_x && a.max_y == b.max_y;
}

void settleWindow(const ExrFrameWindows& windows, v1::ExrWindow& window, Interpretation& result) {
  const ExrWindow& display = windows.display;
  const ExrWindow& data = windows.data;
  if (isSame(display, data) || data.width() < 1 || data.height() < 1) return;
  const ExrWindow all{std::min(display.min_x, data.min_x), std::min(display.min_y, data.min_y),
                      std::max(display.max_x, data.max_x), std::max(display.max_y, data.max_y)};
  const std::string between =
      strCat("data window ", textOf(data), ", display window ", textOf(display));
  if (isInside(data, display)) {
    result.notes.push_back(between + ": no surface where there is no data");
    return;
  }
  if (all.width() > files::kSideMax_px || all.height() > files::kSideMax_px) {
    result.notes.push_back(strCat(between,
                                  ": what is beyond the display window is left out, "
                                  "since planes have at most ",
                                  files::kSideMax_px, " px a side"));
    return;
  }
  window.set_min_x(all.min_x);
  window.set_min_y(all.min_y);
  window.mutable_size()->set_width(static_cast<uint32_t>(all.width()));
  window.mutable_size()->set_height(static_cast<uint32_t>(all.height()));
  result.display = DisplayFrame{.left_px = double(display.min_x) - all.min_x,
                                .top_px = double(display.min_y) - all.min_y,
                                .width_px = double(display.width()),
                                .height_px = double(display.height())};
  result.notes.push_back(between +
                         ": overscan is used, and --fov, --focal-px and --principal-px "
                         "are those of the display window");
}

}  // namespace viewloom::inputs
