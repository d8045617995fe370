// SPDX-License-Identifier: Apache-2.0
#include "cli/outside_text.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "base/str_cat.h"

namespace viewloom::cli {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;
constexpr double kRounding_percent = 1e-6;  // of shares that are whole hundredths

std::string degrees(double low_rad, double high_rad) {
  return strCat(std::ceil((high_rad - low_rad) * kDegPerRad));
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
  std::vector<std::string> lines;
  std::map<uint64_t, std::string> now;
  for (const v1::DisplayOutside& display : wanted.outside()) {
    now[display.display_id()] = outsideText(display.views());
  }
  std::lock_guard lock(mutex_);
  for (const auto& [id, text] : now) {
    if (told_[id] == text) continue;
    lines.push_back(strCat(
        "display ", id, " looks past the source: ", text, "; a field of view of ",
        degrees(wanted.fov().angle_left_rad(), wanted.fov().angle_right_rad()), " x ",
        degrees(wanted.fov().angle_down_rad(), wanted.fov().angle_up_rad()), " degrees is wanted"));
  }
  for (const auto& [id, text] : told_) {
    if (!text.empty() && !now.contains(id)) {
      lines.push_back(strCat("display ", id, " looks past the source no more"));
    }
  }
  told_ = std::move(now);
  return lines;
}

}  // namespace viewloom::cli
