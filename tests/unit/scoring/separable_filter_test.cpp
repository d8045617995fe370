// SPDX-License-Identifier: Apache-2.0
// Filters whose sums are known.
#include "scoring/separable_filter.h"

#include <numeric>

#include <gtest/gtest.h>

namespace viewloom::separable_filter_test {
namespace {

constexpr SizePx kSize = {5, 4};

std::vector<float> counted() {
  std::vector<float> plane(kSize.area());
  std::iota(plane.begin(), plane.end(), 0.0F);
  return plane;
}

TEST(SeparableFilter, ofOneWeightIsThePlane) {
  const std::vector<float> one = {1};
  EXPECT_EQ(filtered(counted(), kSize, one, one), counted());
}

TEST(SeparableFilter, takesTheNextAlongItsAxisAndHoldsTheEdge) {
  const std::vector<float> one = {1};
  const std::vector<float> next = {0, 0, 1};
  const std::vector<float> across = filtered(counted(), kSize, next, one);
  const std::vector<float> down = filtered(counted(), kSize, one, next);
  EXPECT_EQ(across[5], 6);
  EXPECT_EQ(across[9], 9) << "the last of a row";
  EXPECT_EQ(down[5], 10);
  EXPECT_EQ(down[17], 17) << "in the last row";
}

TEST(SeparableFilter, mayBeWiderThanTheImage) {
  const std::vector<float> wide(21, 1.0F / 21);
  const std::vector<float> one = {1};
  // 8 samples of the left edge, 0..4 inside, 8 of the right edge, seen from column 2.
  EXPECT_NEAR(filtered(counted(), kSize, wide, one)[2], (8 * 0 + 10 + 8 * 4) / 21.0, 1e-6);
}

}  // namespace
}  // namespace viewloom::separable_filter_test
