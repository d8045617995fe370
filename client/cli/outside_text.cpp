// SPDX-License-Identifier: Apache-2.0
#include "cli/outside_text.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/str_cat.h"

namespace viewloom::cli {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;
constexpr double kRounding_percent = 1e-6;  // of shares that are whole hundredths

int degrees(double low_rad, double high_rad) {
  return int(std::ceil((high_rad - low_rad) * kDegPerRad));
}

}  // namespace

std::string outsideText(const google::protobuf::RepeatedPtrField<v1::ViewsOutside>& views) {
  std::string text;
  for (const v1::ViewsOutside& run : views) {
    const std::string which = run.first_view() == run.last_view()
                                  ? strCat("view ", run.first_view())
                                  : strCat("views ", run.first_view(), "-", run.last_view());
    text += strCat(text.empty() ? "" : ", ", which, " by ",
                   std::ceil(100 * run.share() - kRounding_percent), " %");
  }
  return text;
}

std::vector<std::string> OutsideWarnings::note(const v1::Wanted& wanted) {
  if (wanted.outside().empty()) return {};
  const int width_deg = degrees(wanted.fov().angle_left_rad(), wanted.fov().angle_right_rad());
  const int height_deg = degrees(wanted.fov().angle_down_rad(), wanted.fov().angle_up_rad());
  std::lock_guard lock(mutex_);
  if (width_deg <= told_width_deg_ && height_deg <= told_height_deg_) return {};
  told_width_deg_ = std::max(told_width_deg_, width_deg);
  told_height_deg_ = std::max(told_height_deg_, height_deg);
  std::vector<std::string> lines;
  for (const v1::DisplayOutside& display : wanted.outside()) {
    lines.push_back(strCat("display ", display.display_id(), " sees past the edge of the source: ",
                           outsideText(display.views()), ". It needs a field of view of ",
                           width_deg, " x ", height_deg, " degrees"));
  }
  return lines;
}

}  // namespace viewloom::cli
