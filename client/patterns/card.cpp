// SPDX-License-Identifier: Apache-2.0
#include "patterns/card.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/str_cat.h"
#include "patterns/finish_pattern.h"
#include "patterns/layer_drawing.h"
#include "text/font.h"

namespace viewloom::patterns {
namespace {

constexpr Rgb kWhite = {255, 255, 255};
constexpr Rgb kBlack = {0, 0, 0};
constexpr Rgb kFrame = {60, 60, 60};

// Half the width of the card's content, in 1080ths from the middle: only frames and corners lie
// outside the narrowest panel.
constexpr double kCardHalfWidth = 288;
constexpr double kColorsTop = -300, kColorsHeight = 110;
constexpr double kStepsTop = -180, kStepsHeight = 70;
constexpr double kRampTop = -100, kRampHeight = 50;
constexpr double kLinesTop = 90, kLinesSide = 120;
constexpr double kCornerLength = 60;
constexpr uint32_t kCodeCount = 256;

struct NamedAspect {
  double aspect;
  std::string_view name;
};
constexpr NamedAspect kAspects[] = {
    {9.0 / 16, "9:16"}, {0.75, "3:4"}, {1.6, "16:10"}, {16.0 / 9, "16:9"}};

PxBox wholePxBox(double left, double top, double right, double bottom) {
  return {std::round(left), std::round(top), std::round(right), std::round(bottom)};
}

// Side by side, without gaps.
template <size_t kCount>
void divide(const PxBox& row, std::array<PxBox, kCount>& parts) {
  for (size_t i = 0; i < kCount; ++i) {
    const double step = row.width() / double{kCount};
    parts[i] = wholePxBox(row.left + static_cast<double>(i) * step, row.top,
                          row.left + static_cast<double>(i + 1) * step, row.bottom);
  }
}

class CardDrawing {
 public:
  explicit CardDrawing(SizePx size_px)
      : size_px_(size_px),
        places_(cardPlaces(size_px)),
        unit_(unitPx(size_px)),
        whole_(wholeImage(size_px)),
        layer_(size_px, kCardPaper) {}

  absl::StatusOr<Pattern> draw() {
    layer_.place(whole_, {.inv_z = kFocalPlane_inv_m});
    drawCircles();
    drawFrames();
    drawColors();
    drawLines();
    drawCorners();
    write(0, 30, 26, strCat("source ", size_px_.width, " x ", size_px_.height, " px"));
    return finishPattern(size_px_, defaultFocalPx(size_px_), {&layer_}, lettering_);
  }

 private:
  Canvas& canvas() { return layer_.canvas(); }

  // Coordinates are 1080ths from the middle.
  void write(double x, double y, double em, const std::string& text) {
    const WrittenText written = lettering_.write(em * unit_, text);
    const double middle_x = whole_.middleX() + x * unit_, middle_y = whole_.middleY() + y * unit_;
    canvas().fill(boxAround(middle_x, middle_y, written.size_px.width, written.size_px.height),
                  kCardPaper);
    canvas().write(written, TextAnchor::kMiddle, middle_x, middle_y, kBlack);
  }

  void drawCircles() {
    const double line_px = std::max(3 * unit_, 1.0);
    canvas().ring(whole_.middleX(), whole_.middleY(), 500 * unit_, line_px, kWhite);
    const double away = 150 * unit_;
    for (const bool right : {false, true}) {
      for (const bool bottom : {false, true}) {
        const double x = right ? whole_.right - away : away;
        const double y = bottom ? whole_.bottom - away : away;
        canvas().ring(x, y, 80 * unit_, line_px, kWhite);
        canvas().line(x - away / 2, y + away / 2, x + away / 2, y - away / 2, line_px, kFrame);
        const std::string name = strCat(bottom ? "B" : "T", right ? "R" : "L");
        const WrittenText written = lettering_.write(44 * unit_, name);
        canvas().fill(boxAround(x, y, written.size_px.width, written.size_px.height), kCardPaper);
        canvas().write(written, TextAnchor::kMiddle, x, y, kBlack);
      }
    }
    const double reach = 520 * unit_;
    canvas().fill(boxAround(whole_.middleX(), whole_.middleY(), line_px, 2 * reach), kFrame);
    canvas().fill(boxAround(whole_.middleX(), whole_.middleY(), 2 * reach, line_px), kFrame);
  }

  // Frames of the parts that views of some shapes show, as they crop the source around its middle.
  void drawFrames() {
    for (const NamedAspect& shape : kAspects) {
      const double width = std::min(whole_.right, whole_.bottom * shape.aspect);
      const PxBox box = boxAround(whole_.middleX(), whole_.middleY(), width, width / shape.aspect);
      canvas().frame(box, std::max(2 * unit_, 1.0), kFrame);
      canvas().write(lettering_.write(20 * unit_, std::string(shape.name)), TextAnchor::kRight,
                     box.right - 8 * unit_, box.top + 24 * unit_, kBlack);
    }
  }

  void drawColors() {
    for (size_t i = 0; i < places_.colors.size(); ++i) {
      canvas().fill(places_.colors[i], kCardColors[i]);
    }
    for (uint32_t i = 0; i < kGreySteps; ++i) {
      const auto code = static_cast<uint8_t>(std::lround(255.0 * i / (kGreySteps - 1)));
      canvas().fill(places_.grey_steps[i], {code, code, code});
    }
    const PxBox& ramp = places_.ramp;
    const auto width = static_cast<uint32_t>(ramp.width());
    for (uint32_t x = 0; x < width; ++x) {
      const auto code = static_cast<uint8_t>(x * kCodeCount / width);
      canvas().fill({ramp.left + x, ramp.top, ramp.left + x + 1, ramp.bottom}, {code, code, code});
    }
  }

  void drawLines() {
    for (uint32_t i = 0; i < kLinePairsMax_px; ++i) {
      const double line_px = i + 1;
      const PxBox& upright = places_.upright_lines[i];
      canvas().fill(upright, kBlack);
      for (double x = upright.left; x < upright.right; x += 2 * line_px) {
        canvas().fill({x, upright.top, x + line_px, upright.bottom}, kWhite);
      }
      const PxBox& level = places_.level_lines[i];
      canvas().fill(level, kBlack);
      for (double y = level.top; y < level.bottom; y += 2 * line_px) {
        canvas().fill({level.left, y, level.right, y + line_px}, kWhite);
      }
      canvas().write(lettering_.write(22 * unit_, strCat(i + 1, " px")), TextAnchor::kMiddle,
                     upright.middleX(), upright.top - 14 * unit_, kBlack);
    }
  }

  // Letters show whether the picture is mirrored or upside down; the border is one pixel wide.
  void drawCorners() {
    const double length = kCornerLength * unit_, line_px = std::max(4 * unit_, 2.0);
    for (const bool right : {false, true}) {
      for (const bool bottom : {false, true}) {
        const double x = right ? whole_.right - length : 0;
        const double y = bottom ? whole_.bottom - length : 0;
        canvas().fill(
            {x, bottom ? whole_.bottom - line_px : 0, x + length, bottom ? whole_.bottom : line_px},
            kWhite);
        canvas().fill(
            {right ? whole_.right - line_px : 0, y, right ? whole_.right : line_px, y + length},
            kWhite);
      }
    }
    write(-220, -362, 90, "R");
    write(220, -362, 90, "F");
    write(0, -362, 30, "up");
    canvas().frame(whole_, 1, kWhite);
  }

  const SizePx size_px_;
  const CardPlaces places_;
  const double unit_;
  const PxBox whole_;
  LayerDrawing layer_;
  Lettering lettering_;
};

}  // namespace

CardPlaces cardPlaces(SizePx size_px) {
  const double unit = unitPx(size_px);
  const double x = size_px.width / 2.0, y = size_px.height / 2.0;
  const auto row = [&](double top, double height) {
    return PxBox{x - kCardHalfWidth * unit, y + top * unit, x + kCardHalfWidth * unit,
                 y + (top + height) * unit};
  };
  CardPlaces places;
  divide(row(kColorsTop, kColorsHeight), places.colors);
  divide(row(kStepsTop, kStepsHeight), places.grey_steps);
  const PxBox ramp = row(kRampTop, kRampHeight);
  places.ramp = wholePxBox(ramp.left, ramp.top, ramp.right, ramp.bottom);
  divide(row(kLinesTop, kLinesSide), places.upright_lines);
  divide(row(kLinesTop + kLinesSide + 20, kLinesSide), places.level_lines);
  return places;
}

absl::StatusOr<Pattern> drawCard(const PatternOptions& options) {
  return CardDrawing(options.size_px).draw();
}

}  // namespace viewloom::patterns
