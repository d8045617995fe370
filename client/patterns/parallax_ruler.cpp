// SPDX-License-Identifier: Apache-2.0
#include "patterns/parallax_ruler.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/str_cat.h"
#include "patterns/finish_pattern.h"
#include "patterns/layer_drawing.h"
#include "text/font.h"

namespace viewloom::patterns {
namespace {

constexpr Rgb kWall = {44, 48, 56};
constexpr Rgb kNear = {246, 196, 92};
constexpr Rgb kFar = {126, 190, 244};
constexpr Rgb kLevel = {196, 200, 204};
constexpr Rgb kInk = {14, 14, 16};
constexpr Rgb kChalk = {232, 234, 238};
constexpr Rgb kZero = {206, 22, 30};

// Layout in 1080ths: rows below each other, in each a label, the sliding ruler and the one on the
// plane.
constexpr double kRowsTop = 76;
constexpr double kRowHeight = 108;
constexpr double kLabelMiddle = 17;
constexpr double kSlidingTop = 32;
constexpr double kSlidingHeight = 40;
constexpr double kFocalHeight = 32;
constexpr double kRulerHalfWidth = 232;

constexpr uint32_t kStepsEachSide = 4;   // each half of the one before
constexpr double kMarkDistance_px = 10;  // of a view
constexpr int kMarksPerNumber = 5;

std::string rowLabel(const RulerRow& row) {
  char text[80];
  const char* const format =
      row.disparity_px == 0 ? "%g px a view  %.4f m" : "%+g px a view  %.4f m";
  std::snprintf(text, sizeof text, format, row.disparity_px, 1 / row.inv_z);
  return text;
}

// Marks from x = zero at every mark_px, standing on the edge of the box or hanging from it.
void drawMarks(const PxBox& box, double zero_px, double mark_px, bool are_hanging, const Rgb& color,
               Canvas& canvas, Lettering& lettering) {
  const int first = static_cast<int>(std::ceil((box.left - zero_px) / mark_px));
  const int last = static_cast<int>(std::floor((box.right - zero_px) / mark_px));
  for (int mark = first; mark <= last; ++mark) {
    const bool is_numbered = mark % kMarksPerNumber == 0;
    const double x = zero_px + mark * mark_px;
    const double length = (is_numbered ? 0.46 : 0.28) * box.height();
    const double thickness = (is_numbered ? 0.22 : 0.14) * mark_px;
    const double middle_y = are_hanging ? box.top + length / 2 : box.bottom - length / 2;
    const Rgb& drawn = mark == 0 ? kZero : color;
    canvas.fill(
        intersection(boxAround(x, middle_y, mark == 0 ? 2 * thickness : thickness, length), box),
        drawn);
    if (!is_numbered) continue;
    const double text_y =
        are_hanging ? box.bottom - 0.28 * box.height() : box.top + 0.28 * box.height();
    const WrittenText number = lettering.write(
        0.5 * box.height(), std::to_string(mark * static_cast<int>(kMarkDistance_px)));
    const double half = number.size_px.width / 2.0;
    if (x - half < box.left || x + half > box.right) continue;
    canvas.write(number, TextAnchor::kMiddle, x, text_y, drawn);
  }
}

class RulerDrawing {
 public:
  explicit RulerDrawing(const PatternOptions& options)
      : options_(options),
        places_(rulerPlaces(options)),
        unit_(unitPx(options.size_px)),
        zero_px_(options.size_px.width / 2.0),
        first_(options.size_px, kWall),
        second_(options.size_px, kWall) {}

  absl::StatusOr<Pattern> draw() {
    first_.place(wholeImage(options_.size_px), {.inv_z = kFocalPlane_inv_m});
    const DisplayViews& views = options_.views;
    first_.canvas().write(
        lettering_.write(26 * unit_, strCat("for ", views.count, " views of ", views.size_px.width,
                                            "x", views.size_px.height, " px, ",
                                            views.cone_rad * 180 / std::numbers::pi, "\u00b0")),
        TextAnchor::kMiddle, zero_px_, places_.rows.front().sliding.top - 56 * unit_, kChalk);
    for (const RulerRow& row : places_.rows) drawRow(row);
    return finishPattern(options_.size_px, places_.focal_px, {&first_, &second_}, lettering_);
  }

 private:
  void drawRow(const RulerRow& row) {
    first_.canvas().write(lettering_.write(24 * unit_, rowLabel(row)), TextAnchor::kLeft,
                          row.sliding.left, row.sliding.top - (kSlidingTop - kLabelMiddle) * unit_,
                          kChalk);
    const PxBox focal{.left = row.sliding.left,
                      .top = row.focal_ruler_top_px,
                      .right = row.sliding.right,
                      .bottom = row.focal_ruler_top_px + kFocalHeight * unit_};
    drawMarks(focal, zero_px_, places_.mark_px, true, kChalk, first_.canvas(), lettering_);
    if (row.inv_z < kFocalPlane_inv_m) {
      drawBehind(row);
      return;
    }
    drawSliding(row.sliding, row.disparity_px > 0 ? kNear : kLevel, first_);
    first_.place(row.sliding, {.inv_z = row.inv_z});
    // A surface before the plane hides it.
    if (row.disparity_px > 0) second_.place(row.sliding, {.inv_z = kFocalPlane_inv_m});
  }

  // Seen through a window in the plane: further to the sides of it, as far as any eye looks.
  void drawBehind(const RulerRow& row) {
    const double reach_px =
        places_.focal_px * options_.views.outermostTangent() * (1 - row.inv_z / kFocalPlane_inv_m);
    PxBox behind = row.sliding;
    behind.left -= std::ceil(reach_px) + 2;
    behind.right += std::ceil(reach_px) + 2;
    LayerDrawing wide(options_.size_px, kWall);
    drawSliding(behind, kFar, wide);
    // Eyes above and below the others see more of it.
    const PxBox tall{.left = behind.left,
                     .top = behind.top - 16 * unit_,
                     .right = behind.right,
                     .bottom = behind.bottom + 16 * unit_};
    wide.canvas().fill({tall.left, tall.top, tall.right, behind.top}, kFar);
    wide.canvas().fill({tall.left, behind.bottom, tall.right, tall.bottom}, kFar);
    wide.place(tall, {.inv_z = row.inv_z});
    second_.copy(wide, tall);
    first_.copy(wide, row.sliding);
    second_.clear(row.sliding);
  }

  void drawSliding(const PxBox& box, const Rgb& color, LayerDrawing& layer) {
    layer.canvas().fill(box, color);
    drawMarks(box, zero_px_, places_.mark_px, false, kInk, layer.canvas(), lettering_);
  }

  const PatternOptions& options_;
  const RulerPlaces places_;
  const double unit_;
  const double zero_px_;
  LayerDrawing first_;
  LayerDrawing second_;
  Lettering lettering_;
};

}  // namespace

RulerPlaces rulerPlaces(const PatternOptions& options) {
  const DisplayViews& views = options.views;
  const double unit = unitPx(options.size_px);
  const double middle = options.size_px.width / 2.0;
  RulerPlaces places{.focal_px = defaultFocalPx(options.size_px), .mark_px = 0, .rows = {}};
  const double view_focal_px = views.focalPx(places.focal_px, options.size_px);
  places.mark_px = kMarkDistance_px * places.focal_px / view_focal_px;
  // Disparity of a surface is f_px pitch (1/Z - 1/D), here with the pitch as a share of D. The
  // farthest ruler may reach as far to the sides as the source sees.
  const double per_share_px = view_focal_px * views.pitchTangent();
  const double reach_share =
      (middle - kRulerHalfWidth * unit - 3) / (places.focal_px * views.outermostTangent());
  const double most_px = per_share_px * std::min(kDepthShareMax, reach_share);
  const double largest_px = std::exp2(std::floor(std::log2(most_px)));
  const double top = (options.size_px.height - 1080 * unit) / 2 + kRowsTop * unit;
  const int steps = static_cast<int>(kStepsEachSide);
  for (int step = 0; step <= 2 * steps; ++step) {
    const int from_plane = steps - step;
    RulerRow row;
    row.disparity_px = from_plane == 0 ? 0
                                       : std::copysign(largest_px, from_plane) *
                                             std::exp2(std::abs(from_plane) - steps);
    row.inv_z = kFocalPlane_inv_m * (1 + row.disparity_px / per_share_px);
    const double row_top = std::round(top + step * kRowHeight * unit);
    row.sliding = {.left = std::round(middle - kRulerHalfWidth * unit),
                   .top = row_top + std::round(kSlidingTop * unit),
                   .right = std::round(middle + kRulerHalfWidth * unit),
                   .bottom = row_top + std::round((kSlidingTop + kSlidingHeight) * unit)};
    row.focal_ruler_top_px = row.sliding.bottom;
    places.rows.push_back(row);
  }
  return places;
}

absl::StatusOr<Pattern> drawParallaxRuler(const PatternOptions& options) {
  return RulerDrawing(options).draw();
}

}  // namespace viewloom::patterns
