// SPDX-License-Identifier: Apache-2.0
// Lines whose view from elsewhere is known.
#include "support/line_map.h"

#include <cmath>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::test::line_map_test {
namespace {

using testing::ElementsAre;
using testing::IsNan;

constexpr double kAllConnected = std::numeric_limits<double>::infinity();

TEST(LineMap, returnsTheLineFromItsOwnPlace) {
  const std::vector<float> disparity_px = {3, 0, 7, 7, 1};
  for (const double cut_px : {-1.0, 0.5, kAllConnected}) {
    EXPECT_THAT(mapLine(disparity_px, {.steps = 0, .cut_px = cut_px}), ElementsAre(0, 1, 2, 3, 4));
  }
}

TEST(LineMap, movesAWallAndShowsNothingWhereItCameFrom) {
  const std::vector<float> disparity_px(5, 2);
  EXPECT_THAT(mapLine(disparity_px, {.steps = 1, .cut_px = 0.5}),
              ElementsAre(2, 3, 4, IsNan(), IsNan()));
  EXPECT_THAT(mapLine(disparity_px, {.steps = -1, .cut_px = 0.5}),
              ElementsAre(IsNan(), IsNan(), 0, 1, 2));
}

TEST(LineMap, seesAStretchedSurfaceBetweenItsSamples) {
  // Sample i comes to 1.6 i: pixel p sees the place p / 1.6.
  const std::vector<float> disparity_px = {0, -0.6F, -1.2F, -1.8F, -2.4F};
  const auto places = mapLine(disparity_px, {.steps = 1, .cut_px = 0.7});
  for (size_t p = 0; p < places.size(); ++p) EXPECT_NEAR(places[p], double(p) / 1.6, 1e-6);
  EXPECT_THAT(mapLine(disparity_px, {.steps = 1, .cut_px = -1}),
              ElementsAre(0, IsNan(), 1, 2, IsNan()))
      << "without connections only what falls into a pixel";
}

TEST(LineMap, letsTheNearerHideTheFurtherAndCutsBetweenThem) {
  // Two samples 2 px nearer than the wall behind them come two pixels to the left.
  const std::vector<float> disparity_px = {0, 0, 0, 2, 2, 0, 0};
  EXPECT_THAT(mapLine(disparity_px, {.steps = 1, .cut_px = 1}),
              ElementsAre(0, 3, 4, IsNan(), IsNan(), 5, 6));
  EXPECT_THAT(mapLine(disparity_px, {.steps = 1, .cut_px = kAllConnected}),
              ElementsAre(0, 3, 4, testing::DoubleNear(4 + 1.0 / 3, 1e-12),
                          testing::DoubleNear(4 + 2.0 / 3, 1e-12), 5, 6))
      << "a sheet spans the hole";
}

TEST(LineMap, endsASurfaceHalfAPixelBeyondItsLastSample) {
  // The lone sample of disparity 1.4 comes to 0.6 and reaches from 0.1 to 1.1.
  const std::vector<float> disparity_px = {-9, -9, 1.4F, -9, -9};
  EXPECT_THAT(mapLine(disparity_px, {.steps = 1, .cut_px = 1}),
              ElementsAre(IsNan(), 2, IsNan(), IsNan(), IsNan()));
}

TEST(LineMap, interpolatesAlongALine) {
  const std::vector<float> line = {1, 3, 7};
  EXPECT_EQ(valueAt(line, 0), 1);
  EXPECT_EQ(valueAt(line, 1.25), 4);
  EXPECT_EQ(valueAt(line, 2), 7);
}

TEST(LineMap, coversAnImageWithLinesInEveryDirection) {
  constexpr SizePx kSize = {5, 3};
  const std::vector<std::pair<int, int>> directions = {{4, 0}, {-1, 0},  {0, 2},
                                                       {3, 3}, {-3, -3}, {2, -2}};
  for (const auto& [columns, rows] : directions) {
    std::multiset<size_t> seen;
    forEachLine(kSize, columns, rows, [&](std::span<const size_t> indices) {
      for (size_t k = 0; k + 1 < indices.size(); ++k) {
        // From one pixel to the next by as many columns as rows, in proportion.
        const int dx = int(indices[k + 1] % kSize.width) - int(indices[k] % kSize.width);
        const int dy = int(indices[k + 1] / kSize.width) - int(indices[k] / kSize.width);
        EXPECT_EQ(dx * rows, dy * columns);
        EXPECT_EQ(std::max(std::abs(dx), std::abs(dy)), 1);
      }
      seen.insert(indices.begin(), indices.end());
    });
    EXPECT_EQ(seen.size(), kSize.area());
    EXPECT_EQ(std::set(seen.begin(), seen.end()).size(), kSize.area());
  }
}

}  // namespace
}  // namespace viewloom::test::line_map_test
