// SPDX-License-Identifier: Apache-2.0
#include "patterns/focal_grid.h"

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

constexpr Rgb kPaper = {232, 230, 222};
constexpr Rgb kFineLine = {160, 170, 178};
constexpr Rgb kStrongLine = {40, 60, 84};
constexpr Rgb kSlant = {36, 66, 96};
constexpr Rgb kSlantLine = {150, 196, 232};
constexpr Rgb kLevelLine = {255, 214, 64};

// Distance in 1080ths.
constexpr double kLineDistance = 12;
constexpr int kLinesPerStrong = 10;
constexpr double kSlantWidth = 480;
constexpr double kSlantHeight = 336;
constexpr double kSlantFromMiddle = 252;  // to either middle

// So that the outermost eye sees a slanted plane half as wide again, or half as wide.
constexpr double kNarrowing = 0.5;

// Lines at every distance_px from zero, along one side of a box.
template <typename Draw>
void forEachLine(double from, double to, double zero, double distance_px, const Draw& draw) {
  const int last = static_cast<int>(std::floor((to - zero) / distance_px));
  for (int i = static_cast<int>(std::ceil((from - zero) / distance_px)); i <= last; ++i) {
    draw(i, zero + i * distance_px);
  }
}

class GridDrawing {
 public:
  explicit GridDrawing(const PatternOptions& options)
      : options_(options),
        places_(gridPlaces(options)),
        unit_(unitPx(options.size_px)),
        whole_(wholeImage(options.size_px)),
        first_(options.size_px, kPaper),
        second_(options.size_px, kPaper) {}

  absl::StatusOr<Pattern> draw() {
    first_.place(whole_, {.inv_z = kFocalPlane_inv_m});
    drawGrid(first_.canvas());
    drawSlanted(places_.turned, true);
    drawSlanted(places_.tilted, false);
    return finishPattern(options_.size_px, places_.focal_px, {&first_, &second_}, lettering_);
  }

 private:
  void drawGrid(Canvas& canvas) {
    const double x0 = whole_.middleX(), y0 = whole_.middleY();
    for (const bool strong : {false, true}) {
      const Rgb& color = strong ? kStrongLine : kFineLine;
      const double line_px = strong ? std::max(2 * unit_, 1.0) : std::max(unit_, 1.0);
      const double distance_px = places_.line_distance_px * (strong ? kLinesPerStrong : 1);
      forEachLine(0, whole_.right, x0, distance_px, [&](int, double x) {
        canvas.fill(boxAround(x, y0, line_px, whole_.bottom), color);
      });
      forEachLine(0, whole_.bottom, y0, distance_px, [&](int, double y) {
        canvas.fill(boxAround(x0, y, whole_.right, line_px), color);
      });
    }
    const double strong_px = kLinesPerStrong * places_.line_distance_px;
    forEachLine(0, whole_.right, x0, strong_px, [&](int column, double x) {
      forEachLine(0, whole_.bottom, y0, strong_px, [&](int row, double y) {
        const std::string place = strCat(column, ",", -row);
        const WrittenText text = lettering_.write(20 * unit_, place);
        const PxBox paper = boxAround(x, y, text.size_px.width + 6 * unit_, text.size_px.height);
        canvas.fill(paper, kPaper);
        canvas.write(text, TextAnchor::kMiddle, x, y, kStrongLine);
      });
    });
  }

  // The plane is wider than its window by what the outermost eyes see beside it.
  void drawSlanted(const PxBox& box, bool is_turned) {
    LayerDrawing plane(options_.size_px, kSlant);
    const double slope = places_.inv_z_per_px;
    const PxBox seen =
        is_turned
            ? boxAround(box.middleX(), box.middleY(), 2 * box.width(), box.height())
            : boxAround(box.middleX(), box.middleY(), 2 * box.width(), box.height() + 32 * unit_);
    drawTexture(seen, is_turned, plane.canvas());
    plane.place(seen, {.inv_z = kFocalPlane_inv_m,
                       .slope_x = is_turned ? -slope : 0,
                       .slope_y = is_turned ? 0 : slope});
    const PxBox near = is_turned ? PxBox{box.left, box.top, box.middleX(), box.bottom}
                                 : PxBox{box.left, box.middleY(), box.right, box.bottom};
    const PxBox far = is_turned ? PxBox{box.middleX(), box.top, box.right, box.bottom}
                                : PxBox{box.left, box.top, box.right, box.middleY()};
    const PxBox seen_far = is_turned ? PxBox{box.middleX(), seen.top, seen.right, seen.bottom}
                                     : PxBox{seen.left, seen.top, seen.right, box.middleY()};
    second_.copy(first_, near);  // the grid goes on behind what stands before it
    second_.copy(plane, seen_far);
    second_.clear(far);
    first_.copy(plane, box);
  }

  void drawTexture(const PxBox& box, bool is_turned, Canvas& canvas) {
    const double x0 = box.middleX(), y0 = box.middleY();
    const double line_px = std::max(unit_, 1.0);
    forEachLine(box.left, box.right, x0, 2 * places_.line_distance_px, [&](int, double x) {
      canvas.fill(boxAround(x, y0, line_px, box.height()), kSlantLine);
    });
    forEachLine(box.top, box.bottom, y0, 2 * places_.line_distance_px, [&](int, double y) {
      canvas.fill(boxAround(x0, y, box.width(), line_px), kSlantLine);
    });
    // Where it is a px of disparity further from the plane.
    const DisplayViews& views = options_.views;
    const double px_per_inv_z = views.focalPx(places_.focal_px, options_.size_px) *
                                views.pitchTangent() / kFocalPlane_inv_m;
    const double distance_px = 1 / (px_per_inv_z * places_.inv_z_per_px);
    const double half_px = (is_turned ? box.width() : box.height()) / 2;
    forEachLine(-half_px, half_px, 0, distance_px, [&](int disparity_px, double way) {
      const double x = is_turned ? x0 - way : x0, y = is_turned ? y0 : y0 + way;
      canvas.fill(is_turned ? boxAround(x, y0, 3 * unit_, box.height())
                            : boxAround(x0, y, box.width(), 3 * unit_),
                  kLevelLine);
      char label[32];
      std::snprintf(label, sizeof label, disparity_px == 0 ? "0" : "%+d", disparity_px);
      const WrittenText text = lettering_.write(22 * unit_, label);
      canvas.fill(boxAround(x, y, text.size_px.width + 8 * unit_, text.size_px.height), kSlant);
      canvas.write(text, TextAnchor::kMiddle, x, y, kLevelLine);
    });
  }

  const PatternOptions& options_;
  const GridPlaces places_;
  const double unit_;
  const PxBox whole_;
  LayerDrawing first_;
  LayerDrawing second_;
  Lettering lettering_;
};

}  // namespace

GridPlaces gridPlaces(const PatternOptions& options) {
  const double unit = unitPx(options.size_px);
  const double x = options.size_px.width / 2.0, y = options.size_px.height / 2.0;
  const double width = 2 * std::round(kSlantWidth * unit / 2);
  const double height = 2 * std::round(kSlantHeight * unit / 2);
  const double away = std::round(kSlantFromMiddle * unit);
  GridPlaces places{.focal_px = defaultFocalPx(options.size_px),
                    .line_distance_px = kLineDistance * unit,
                    .turned = boxAround(x, std::round(y - away), width, height),
                    .tilted = boxAround(x, std::round(y + away), width, height),
                    .inv_z_per_px = 0};
  // The source has at q what an eye at tangent t sees at p = q + f t (1 - D/Z); where 1/Z changes
  // with q, dp/dq = 1 - f t D (d1/Z / dq).
  const double steepest = kNarrowing / (places.focal_px * options.views.outermostTangent());
  const double deepest = kDepthShareMax / width;  // twice its half: behind the window's sides
  places.inv_z_per_px = kFocalPlane_inv_m * std::min(steepest, deepest);
  return places;
}

absl::StatusOr<Pattern> drawFocalGrid(const PatternOptions& options) {
  return GridDrawing(options).draw();
}

}  // namespace viewloom::patterns
