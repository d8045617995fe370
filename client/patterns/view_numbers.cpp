// SPDX-License-Identifier: Apache-2.0
#include "patterns/view_numbers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/str_cat.h"
#include "patterns/finish_pattern.h"
#include "patterns/layer_drawing.h"
#include "text/font.h"

namespace viewloom::patterns {
namespace {

constexpr Rgb kNumberPlate = {58, 62, 70};
constexpr Rgb kWall = {18, 18, 22};
constexpr Rgb kPaper = {236, 232, 220};
constexpr Rgb kInk = {16, 16, 16};
constexpr Rgb kWhite = {255, 255, 255};
constexpr Rgb kBlack = {0, 0, 0};

// Sizes in widths of a number: the code below the digits, and the angle, which reads upwards.
constexpr double kDigitsHeight = 3.0;
constexpr double kBlockSide = 0.4;
constexpr double kCodeTop = 3.3;
constexpr double kAngleMiddle = 7.9;
constexpr double kNumberHeight = 9.4;
// The window stays below the 2 % of px that do not count as the depth of a stream.
constexpr double kWindowShareMax = 0.015;
constexpr uint32_t kCodeBits = 10;

double narrowestPitch(const DisplayViews& views) {
  const uint32_t middle = views.count / 2;  // tangents are closest together in the middle
  return views.eyeTangent(middle) - views.eyeTangent(middle - 1);
}

std::string angleText(double angle_rad) {
  char text[32];
  std::snprintf(text, sizeof text, "%+.1f\u00b0", angle_rad * 180 / std::numbers::pi);
  return text;
}

void drawNumber(const PatternOptions& options, uint32_t number, const PxBox& place, Canvas& wall,
                Lettering& lettering) {
  const double width = place.width();
  wall.fill(place, kPaper);
  const std::string digits = std::to_string(number);
  const size_t count = std::to_string(options.views.count - 1).size();
  // A digit below the other, so that they are as large as can be.
  const double line_px = kDigitsHeight * width / static_cast<double>(count);
  const double em_px = std::min(1.2 * width, line_px);
  for (size_t i = 0; i < digits.size(); ++i) {
    const double line =
        static_cast<double>(i) + 0.5 + static_cast<double>(count - digits.size()) / 2;
    wall.write(lettering.write(em_px, digits.substr(i, 1)), TextAnchor::kMiddle, place.middleX(),
               place.top + 0.15 * width + line * line_px, kInk);
  }
  const auto code = codeOf(number);
  for (uint32_t i = 0; i < code.size(); ++i) {
    wall.fill(codeBlock(place, i / kCodeColumns, i % kCodeColumns), code[i] ? kWhite : kBlack);
  }
  wall.writeUpwards(lettering.write(0.62 * width, angleText(options.views.angle_rad(number))),
                    place.middleX(), place.top + kAngleMiddle * width, kInk);
}

void drawPlate(const PatternOptions& options, const PxBox& window, Canvas& plate,
               Lettering& lettering) {
  const double unit = unitPx(options.size_px);
  const double gap = 8 * unit;
  plate.frame({window.left - gap, window.top - gap, window.right + gap, window.bottom + gap},
              4 * unit, kPaper);
  const double middle = options.size_px.width / 2.0;
  const std::string cone = strCat(options.views.count, " views, ",
                                  options.views.cone_rad * 180 / std::numbers::pi, "\u00b0 wide");
  plate.write(lettering.write(40 * unit, cone), TextAnchor::kMiddle, middle, 50 * unit, kPaper);
  plate.write(lettering.write(26 * unit, "view 0 is the leftmost eye's"), TextAnchor::kMiddle,
              middle, 100 * unit, kPaper);
}

}  // namespace

double NumberPlaces::middleOnStrip(double eye_tangent) const {
  return window.middleX() - reach_px * eye_tangent;
}

absl::StatusOr<NumberPlaces> numberPlaces(const PatternOptions& options) {
  const DisplayViews& views = options.views;
  const double width = options.size_px.width, height = options.size_px.height;
  const double pitch = narrowestPitch(views);
  const double outermost = views.outermostTangent();
  // All of them beside each other, a px free at either end; or narrower, so that they are no taller
  // than a window may be.
  const double tallest = std::sqrt(kWindowShareMax * width * height / kNumberHeight);
  const double beside = (width - 2) / (2 * outermost / pitch + 1);
  const double number_px = 2 * std::floor(std::min(tallest, beside) / 2);
  if (number_px < kNumberMin_px) {
    const double wanted_px = (kNumberMin_px + 1) * (2 * outermost / pitch + 1) + 2;
    return absl::InvalidArgumentError(
        strCat("--views ", views.count, ": ", beside, " px of --size ", options.size_px.width, "x",
               options.size_px.height, " are left for each number, accepted are ", kNumberMin_px,
               " or more: fewer views, or frames ", std::ceil(wanted_px), " px wide"));
  }
  NumberPlaces places;
  places.reach_px = (width - 2 - number_px) / (2 * outermost);
  places.focal_px = places.reach_px / (1 - kStripDepthShare);
  places.window = {.left = std::floor((width - number_px) / 2),
                   .top = std::floor((height - kNumberHeight * number_px) / 2),
                   .right = 0,
                   .bottom = 0};
  places.window.right = places.window.left + number_px;
  places.window.bottom = places.window.top + std::floor(kNumberHeight * number_px);
  return places;
}

PxBox codeBlock(const PxBox& window, uint32_t row, uint32_t column) {
  const double side = kBlockSide * window.width();
  const double left = window.middleX() + (column - kCodeColumns / 2.0) * side;
  const double top = window.top + kCodeTop * window.width() + row * side;
  // Whole px, so that nothing shows between them.
  return {.left = std::round(left),
          .top = std::round(top),
          .right = std::round(left + side),
          .bottom = std::round(top + side)};
}

std::array<bool, size_t{kCodeRows} * kCodeColumns> codeOf(uint32_t number) {
  std::array<bool, size_t{kCodeRows} * kCodeColumns> code{};
  code.front() = true;
  for (uint32_t bit = 0; bit < kCodeBits; ++bit) {
    code[kCodeColumns + bit] = (number >> (kCodeBits - 1 - bit) & 1) != 0;
  }
  const bool is_odd = std::popcount(number) % 2 == 1;
  code[code.size() - 2] = is_odd;
  code[code.size() - 1] = !is_odd;
  return code;
}

absl::StatusOr<Pattern> drawViewNumbers(const PatternOptions& options) {
  const absl::StatusOr<NumberPlaces> places = numberPlaces(options);
  if (!places.ok()) return places.status();
  Lettering lettering;
  LayerDrawing plate(options.size_px, kNumberPlate);
  LayerDrawing strip(options.size_px, kWall);
  const PxBox whole = wholeImage(options.size_px);
  plate.place(whole, {.inv_z = kFocalPlane_inv_m});
  strip.place(whole, {.inv_z = kStripDepthShare * kFocalPlane_inv_m});
  for (uint32_t view = 0; view < options.views.count; ++view) {
    PxBox place = places->window;
    // On whole px: half a px beside where it is seen exactly, at most.
    place.left =
        std::round(places->middleOnStrip(options.views.eyeTangent(view)) - place.width() / 2);
    place.right = place.left + places->window.width();
    drawNumber(options, view, place, strip.canvas(), lettering);
  }
  drawPlate(options, places->window, plate.canvas(), lettering);
  plate.copy(strip, places->window);
  strip.clear(places->window);
  return finishPattern(options.size_px, places->focal_px, {&plate, &strip}, lettering);
}

}  // namespace viewloom::patterns
