// SPDX-License-Identifier: Apache-2.0
#include "pictures/slice.h"

#include <algorithm>

#include "base/str_cat.h"
#include "pictures/scene_to_draw.h"

namespace viewloom::pictures {
namespace {

constexpr double kColumn_px = 19;
constexpr double kLeft_px = 44;
constexpr double kTop_px = 34;
constexpr double kHeight_px = 280;
constexpr double kInvZMax = 0.9;  // 1/m, above all of the scene
constexpr double kStrip_px = 30;  // from strip to strip
constexpr double kRight_px = kLeft_px + kDrawnColumns * kColumn_px;
constexpr double kBottom_px = kTop_px + kHeight_px;
constexpr double kBelowAxis_px = 34;

int heightOf(int strip_count) {
  return int(kBottom_px + kBelowAxis_px + 20 + strip_count * kStrip_px);
}

}  // namespace

Slice::Slice(std::string_view heading, int strip_count)
    : svg_(int(kRight_px) + 16, heightOf(strip_count)), strip_count_(strip_count) {
  svg_.text({kLeft_px, 20}, heading, "");
  for (int column = 0; column <= kDrawnColumns; ++column) {
    const double x_px = kFirstDrawnColumn + column;
    svg_.line(at(x_px, 0), at(x_px, kInvZMax), "grid");
    if (column % 5 == 0) {
      svg_.text({at(x_px, 0).x, kBottom_px + 14}, strCat(x_px), "small middle");
    }
  }
  for (int tenths = 0; tenths <= 8; tenths += 2) {
    svg_.text({kLeft_px - 6, at(0, tenths / 10.0).y + 4}, strCat(tenths / 10.0), "small end");
  }
  svg_.line(at(kFirstDrawnColumn, 0), at(kFirstDrawnColumn + kDrawnColumns, 0), "axis");
  svg_.line(at(kFirstDrawnColumn, 0), at(kFirstDrawnColumn, kInvZMax), "axis");
  svg_.text({kRight_px, kBottom_px + 28}, "x, px", "small end");
  svg_.text({6, kTop_px - 4}, "1/Z, 1/m", "small");
}

Point Slice::at(double x_px, double inv_z) const {
  return {kLeft_px + (x_px - kFirstDrawnColumn) * kColumn_px,
          kBottom_px - inv_z / kInvZMax * kHeight_px};
}

bool Slice::shows(double x_px) const {
  return x_px >= kFirstDrawnColumn && x_px <= kFirstDrawnColumn + kDrawnColumns;
}

void Slice::line(double from_px, double from_inv_z, double to_px, double to_inv_z,
                 std::string_view style) {
  const double first_px = kFirstDrawnColumn;
  const double last_px = first_px + kDrawnColumns;
  const double extent_px = to_px - from_px;
  double from = 0;
  double to = 1;
  if (extent_px != 0) {
    const double at_first = (first_px - from_px) / extent_px;
    const double at_last = (last_px - from_px) / extent_px;
    from = std::max(from, std::min(at_first, at_last));
    to = std::min(to, std::max(at_first, at_last));
  } else if (!shows(from_px)) {
    return;
  }
  if (from >= to) return;
  const auto between = [&](double share) {
    return at(from_px + share * extent_px, from_inv_z + share * (to_inv_z - from_inv_z));
  };
  svg_.line(between(from), between(to), style);
}

void Slice::note(std::string_view words) {
  svg_.text({kLeft_px, heightOf(strip_count_) - 6.0}, words, "small");
}

Point Slice::stripAt(int strip, double x_px) const {
  return {at(x_px, 0).x, kBottom_px + kBelowAxis_px + strip * kStrip_px};
}

double Slice::stripPx() {
  return kColumn_px;
}

void Slice::nameStrip(int strip, std::string_view words) {
  svg_.text({kLeft_px - 6, stripAt(strip, 0).y + 14}, words, "small end");
}

std::string ofLayer(std::string_view style, int layer) {
  return strCat(style, layer);
}

}  // namespace viewloom::pictures
