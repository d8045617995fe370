// SPDX-License-Identifier: Apache-2.0
// Where rays pass through a lens: which shape their points fill, and how evenly.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "display/lens.h"

namespace viewloom::lens_points_test {
namespace {

constexpr uint32_t kWalked = 8;
constexpr uint32_t kGathered = 32;
constexpr double kTurn_rad = 2 * std::numbers::pi;
// Error in lens radii: points are binary32 results of about ten operations.
constexpr double kRounding = 1e-6;
// Error in lens radii. The mean of 2560 independent points would be off by 0.5 / sqrt(2560) =
// 0.01; that of evenly spread points is off by less than a third of it.
constexpr double kMomentError = 3e-3;

std::vector<glm::vec2> pointsOf(uint32_t blades, double rotation_rad = 0) {
  return lensPoints({.blades = blades,
                     .rotation_rad = rotation_rad,
                     .walked_count = kWalked,
                     .gathered_count = kGathered});
}

glm::dvec2 towards(double angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

// How far the points reach in a direction.
double reachOf(const std::vector<glm::vec2>& points, double angle_rad) {
  double reach = 0;
  for (const glm::dvec2 at : points) reach = std::max(reach, glm::dot(at, towards(angle_rad)));
  return reach;
}

struct Moments {
  glm::dvec2 mean{0.0};
  glm::dvec2 squares{0.0};  // means of x^2 and of y^2
  double product = 0;       // mean of x y
};

Moments momentsOf(const std::vector<glm::vec2>& points) {
  Moments sum;
  const auto count = double(points.size());
  for (const glm::dvec2 at : points) {
    sum.mean += at / count;
    sum.squares += at * at / count;
    sum.product += at.x * at.y / count;
  }
  return sum;
}

// `square`: the mean of x^2, and of y^2, over the shape that is filled.
void expectEven(const std::vector<glm::vec2>& points, double square) {
  const Moments got = momentsOf(points);
  std::cout << "mean " << got.mean.x << ", " << got.mean.y << "; squares " << got.squares.x - square
            << ", " << got.squares.y - square << " off; product " << got.product << "\n";
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_NEAR(got.mean[axis], 0, kMomentError);
    EXPECT_NEAR(got.squares[axis], square, kMomentError);
  }
  EXPECT_NEAR(got.product, 0, kMomentError);
}

struct Opening {
  uint32_t blades;
  double rotation_rad;
};
class BladedLens : public testing::TestWithParam<Opening> {};
INSTANTIATE_TEST_SUITE_P(Openings, BladedLens,
                         testing::Values(Opening{3, 0}, Opening{4, 0.2}, Opening{5, 0},
                                         Opening{5, -0.7}, Opening{16, 0.1}));

TEST_P(BladedLens, endsAtItsBladesAndReachesItsCorners) {
  const auto [blades, rotation_rad] = GetParam();
  const std::vector<glm::vec2> points = pointsOf(blades, rotation_rad);
  // Lens radii: the outermost of the points is so near to a corner, by 2560 of them.
  constexpr double kCornerGap = 0.08;
  const double blade_reach = std::cos(std::numbers::pi / blades);
  for (uint32_t i = 0; i < blades; ++i) {
    const double corner_rad = rotation_rad + i * kTurn_rad / blades;
    const double middle_rad = corner_rad + kTurn_rad / blades / 2;
    EXPECT_LE(reachOf(points, middle_rad), blade_reach + kRounding) << "beyond blade " << i;
    EXPECT_GT(reachOf(points, middle_rad), blade_reach - kCornerGap) << i;
    EXPECT_GT(reachOf(points, corner_rad), 1 - kCornerGap) << "corner " << i << " is empty";
  }
}

// Means over a regular polygon with its corners on a circle of radius 1.
TEST_P(BladedLens, isFilledEvenly) {
  const auto [blades, rotation_rad] = GetParam();
  expectEven(pointsOf(blades, rotation_rad), (2 + std::cos(kTurn_rad / blades)) / 12);
}

TEST_P(BladedLens, turnsCounterclockwise) {
  const auto [blades, rotation_rad] = GetParam();
  const std::vector<glm::vec2> upright = pointsOf(blades);
  const std::vector<glm::vec2> turned = pointsOf(blades, rotation_rad);
  const glm::dvec2 right = towards(rotation_rad);
  const glm::dvec2 up(-right.y, right.x);
  ASSERT_EQ(turned.size(), upright.size());
  for (size_t i = 0; i < turned.size(); ++i) {
    const glm::dvec2 expected = double(upright[i].x) * right + double(upright[i].y) * up;
    ASSERT_LE(glm::distance(expected, glm::dvec2(turned[i])), kRounding) << i;
  }
}

TEST(RoundLens, isAFullDisc) {
  const std::vector<glm::vec2> points = pointsOf(0);
  constexpr uint32_t kDirections = 32;
  // Gap between the edge and the outermost of 2560 points in any direction, in lens radii.
  constexpr double kRimGap = 0.03;
  for (uint32_t i = 0; i < kDirections; ++i) {
    EXPECT_GT(reachOf(points, i * kTurn_rad / kDirections), 1 - kRimGap) << i;
  }
  for (const glm::dvec2 at : points) ASSERT_LE(glm::length(at), 1 + kRounding);
  expectEven(points, 0.25);
  EXPECT_EQ(pointsOf(0, 1), points) << "turned, it is the same";
}

// RMS distance of the means of these point sets from the centre of the lens, in lens radii.
double offMiddle(const std::vector<std::vector<glm::vec2>>& shapes) {
  double squares = 0;
  for (const std::vector<glm::vec2>& shape : shapes) {
    const glm::dvec2 mean = momentsOf(shape).mean;
    squares += glm::dot(mean, mean) / double(shapes.size());
  }
  return std::sqrt(squares);
}

// The same distance for independent points.
double offMiddleByChance(uint32_t point_count) {
  return std::sqrt(0.5 / point_count);
}

TEST(LensPattern, spreadsTheRaysOfEachPx) {
  const std::vector<glm::vec2> points = pointsOf(0);
  for (const uint32_t count : {kWalked, kWalked + kGathered}) {
    std::vector<std::vector<glm::vec2>> of_px(kLensPatternArea_px);
    for (uint32_t i = 0; i < count * kLensPatternArea_px; ++i) {
      of_px[i % kLensPatternArea_px].push_back(points[i]);
    }
    const double off = offMiddle(of_px);
    std::cout << "the first " << count << " of a px are off the middle by " << off << "\n";
    // Evenly spread points are nearer by at least this factor.
    EXPECT_LT(off, 0.75 * offMiddleByChance(count));
  }
}

// Point sets: one ray of each pixel of a square.
std::vector<std::vector<glm::vec2>> ofSquares(uint32_t side_px) {
  const uint32_t across = kLensPatternSide_px / side_px;
  const std::vector<glm::vec2> points = pointsOf(0);
  const uint32_t squares = across * across;
  std::vector<std::vector<glm::vec2>> shapes((kWalked + kGathered) * squares);
  for (uint32_t i = 0; i < points.size(); ++i) {
    const uint32_t x = i % kLensPatternSide_px / side_px;
    const uint32_t y = i / kLensPatternSide_px % kLensPatternSide_px / side_px;
    shapes[i / kLensPatternArea_px * squares + y * across + x].push_back(points[i]);
  }
  return shapes;
}

// Four rays in a square's quarters are half as far off as random ones. More rays do better.
TEST(LensPattern, spreadsEachRayOverTheLensFromPxToPx) {
  constexpr struct {
    uint32_t side_px;
    double of_chance;  // seen 0.53, 0.28, 0.14
  } kSquares[] = {{2, 0.65}, {4, 0.35}, {8, 0.2}};
  for (const auto [side_px, of_chance] : kSquares) {
    const double off = offMiddle(ofSquares(side_px));
    std::cout << "one of each of " << side_px << "x" << side_px << " px is off the middle by "
              << off << "\n";
    EXPECT_LT(off, of_chance * offMiddleByChance(side_px * side_px));
  }
}

// Otherwise noise of few rays would form a visible pattern, and blocks would find fewer surfaces.
TEST(LensPattern, givesNoPxTheFirstRaysOfAnother) {
  const std::vector<glm::vec2> points = pointsOf(0);
  const uint32_t first_count = kWalked * kLensPatternArea_px;
  double nearest = std::numeric_limits<double>::infinity();
  for (uint32_t i = 0; i < first_count; ++i) {
    for (uint32_t j = 0; j < i; ++j) {
      nearest = std::min(nearest, double(glm::distance(points[i], points[j])));
    }
  }
  std::cout << "nearest of " << first_count << " first rays: " << nearest << "\n";
  // Lens radii: as many on a square lattice would be sqrt(pi / 512) = 0.08 apart.
  constexpr double kApart = 4e-3;
  EXPECT_GT(nearest, kApart);
}

TEST(LensPattern, sendsRaysOfPxBesideEachOtherElsewhere) {
  const std::vector<glm::vec2> points = pointsOf(0);
  constexpr uint32_t kSide_px = kLensPatternSide_px;
  double to_right = 0;
  double to_below = 0;
  constexpr uint32_t kCount = kWalked * kLensPatternArea_px;
  for (uint32_t i = 0; i < kCount; ++i) {
    const uint32_t x_px = i % kSide_px;
    const uint32_t y_px = i / kSide_px % kSide_px;
    const uint32_t first = i - i % kLensPatternArea_px;
    const uint32_t right = first + y_px * kSide_px + (x_px + 1) % kSide_px;
    const uint32_t below = first + (y_px + 1) % kSide_px * kSide_px + x_px;
    to_right += double(glm::distance(points[i], points[right])) / kCount;
    to_below += double(glm::distance(points[i], points[below])) / kCount;
  }
  std::cout << "to the right " << to_right << ", below " << to_below << " apart\n";
  // Lens radii: two independent points of a disc are 128 / (45 pi) = 0.905 apart in the mean.
  constexpr double kApart = 0.75 * 0.905;
  EXPECT_GT(to_right, kApart);
  EXPECT_GT(to_below, kApart);
}

}  // namespace
}  // namespace viewloom::lens_points_test
