// SPDX-License-Identifier: Apache-2.0
#include "lib/undefined_colors.h"

#include <gtest/gtest.h>

#include <vector>

#include "lib/inverse_depth.h"

namespace viewloom::undefined_colors_test {
namespace {

TEST(UndefinedColors, takeTheMeanOfTheSurfacesInTheirBlock) {
  const SizePx size_px{16, 2};
  std::vector<float> inv_z(32, 1);
  std::vector<uint8_t> rgb(32 * 3, 100);
  inv_z[5] = inv_z[31] = kNoInvZ;
  rgb[5 * 3] = rgb[31 * 3 + 2] = 7;
  rgb[0] = 130;  // of 30 surfaces one is 30 codes redder
  fillUndefinedColors(inv_z, size_px, 3, rgb);
  for (const size_t pixel : {5, 31}) {
    EXPECT_EQ(rgb[pixel * 3], 101);
    EXPECT_EQ(rgb[pixel * 3 + 1], 100);
    EXPECT_EQ(rgb[pixel * 3 + 2], 100);
  }
  EXPECT_EQ(rgb[0], 130) << "surfaces keep their colour";
}

TEST(UndefinedColors, goOnFromTheBlockBefore) {
  const SizePx size_px{40, 17};  // three blocks in each of two rows, the last of them cut
  std::vector<float> inv_z(size_px.area(), kNoInvZ);
  std::vector<uint8_t> rgba(size_px.area() * 4, 9);
  inv_z[20] = 2;
  rgba[80] = 50;
  rgba[81] = 60;
  rgba[82] = 70;
  fillUndefinedColors(inv_z, size_px, 4, rgba);
  const size_t last = size_px.area() - 1;
  EXPECT_EQ(rgba[0], 0) << "no surface came before";
  for (const size_t pixel : {size_t{17}, size_t{39}, last}) {
    EXPECT_EQ(rgba[4 * pixel], 50);
    EXPECT_EQ(rgba[4 * pixel + 2], 70);
    EXPECT_EQ(rgba[4 * pixel + 3], 9) << "the fourth channel stays";
  }
}

}  // namespace
}  // namespace viewloom::undefined_colors_test
