// SPDX-License-Identifier: Apache-2.0
#include "patterns/canvas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/srgb_transfer.h"

namespace viewloom::patterns::canvas_test {
namespace {

constexpr Rgb kBlack = {0, 0, 0};
constexpr Rgb kWhite = {255, 255, 255};

int codeAt(const Canvas& canvas, uint32_t x, uint32_t y) {
  return canvas.rgba()[4 * (size_t{y} * canvas.sizePx().width + x)];
}

// In px, as light.
double lightOf(const Canvas& canvas) {
  double light = 0;
  for (size_t i = 0; i < canvas.rgba().size(); i += 4) {
    light += linearFrom(canvas.rgba()[i] / 255.0);
  }
  return light;
}

TEST(Canvas, fillsWholePxWithTheColourAlone) {
  Canvas canvas({8, 6}, {1, 2, 3});
  canvas.fill({2, 1, 5, 4}, {200, 100, 50});
  for (uint32_t y = 0; y < 6; ++y) {
    for (uint32_t x = 0; x < 8; ++x) {
      const bool is_inside = x >= 2 && x < 5 && y >= 1 && y < 4;
      EXPECT_EQ(codeAt(canvas, x, y), is_inside ? 200 : 1) << x << ", " << y;
    }
  }
}

TEST(Canvas, blendsPartsOfPxAsLight) {
  Canvas canvas({4, 4}, kBlack);
  canvas.fill({1.5, 1, 3, 1.5}, kWhite);
  EXPECT_EQ(codeAt(canvas, 1, 1), std::lround(255 * srgbFrom(0.25)));
  EXPECT_EQ(codeAt(canvas, 2, 1), std::lround(255 * srgbFrom(0.5)));
  EXPECT_EQ(codeAt(canvas, 3, 1), 0);
}

TEST(Canvas, leavesOutWhatIsBesideThePicture) {
  Canvas canvas({4, 4}, kBlack);
  canvas.fill({-10, -10, 1, 1}, kWhite);
  canvas.line(-5, 2.5, 9, 2.5, 1, kWhite);
  canvas.write({.size_px = {2, 2}, .coverage = {255, 255, 255, 255}}, TextAnchor::kLeft, -1, 0,
               kWhite);
  EXPECT_EQ(lightOf(canvas), 1 + 4);
}

TEST(Canvas, drawsRingsAndLinesOfTheirArea) {
  Canvas ring({100, 100}, kBlack);
  ring.ring(50.3, 49.8, 30, 3, kWhite);
  const double area = 2 * std::numbers::pi * 30 * 3;
  EXPECT_NEAR(lightOf(ring), area, 0.01 * area);
  EXPECT_EQ(codeAt(ring, 50, 50), 0) << "its middle is free";
  Canvas line({100, 100}, kBlack);
  line.line(10, 20, 80, 60, 2, kWhite);
  const double length = std::hypot(70, 40);
  EXPECT_NEAR(lightOf(line), 2 * length, 0.02 * 2 * length);
}

TEST(Canvas, turnsTextToTheLeft) {
  // Two px wide, one high: white on the left, black on the right.
  const WrittenText text{.size_px = {2, 1}, .coverage = {255, 0}};
  Canvas canvas({2, 2}, kBlack);
  canvas.writeUpwards(text, 0.5, 1, kWhite);
  EXPECT_EQ(codeAt(canvas, 0, 1), 255) << "what was left is below";
  EXPECT_EQ(lightOf(canvas), 1);
}

}  // namespace
}  // namespace viewloom::patterns::canvas_test
