// SPDX-License-Identifier: Apache-2.0
// Rivals and mask on a scene of two walls whose views are known.
#include "fidelity/rivals.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::fidelity::rivals_test {
namespace {

using testing::ElementsAre;
using enum PixelClass;

// Rows of a grey ramp; columns 3 and 4 are 2 px of disparity nearer than the rest.
test::DataSet twoWalls() {
  test::DataSet set = {.size_px = {7, 7}};
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 7; ++x) set.disparity_px.push_back(x == 3 || x == 4 ? 2.0F : 0.0F);
  }
  return set;
}

ScoredImage ramp(SizePx size_px) {
  ScoredImage image = {.size_px = size_px, .rgb = {}};
  for (size_t i = 0; i < 3 * size_px.area(); ++i) {
    image.rgb.push_back(float(i / 3 % size_px.width) / 10);
  }
  return image;
}

std::vector<float> row(const ScoredImage& image, size_t y) {
  std::vector<float> reds;
  for (size_t x = 0; x < image.size_px.width; ++x) {
    reds.push_back(image.rgb[3 * (y * image.size_px.width + x)]);
  }
  return reds;
}

ScoredImage viewBy(const std::string& name, const test::TrueView& view) {
  const auto rivals = rivalsOf(1);
  const auto rival = std::find_if(rivals.begin(), rivals.end(),
                                  [&](const Rival& each) { return each.name == name; });
  const test::DataSet set = twoWalls();
  return rivalView(ramp(set.size_px), set, view, *rival);
}

TEST(Rivals, fillHolesFromTheFarSide) {
  // The near wall comes from columns 3 and 4 to 1 and 2; what it hid takes the next of the far
  // wall, which is on the right.
  const test::TrueView right = {.columns = 1};
  for (const char* name : {"splat", "cut mesh"}) {
    EXPECT_THAT(row(viewBy(name, right), 5), ElementsAre(0.0F, 0.3F, 0.4F, 0.5F, 0.5F, 0.5F, 0.6F))
        << name;
  }
  const test::TrueView left = {.columns = -1};
  EXPECT_THAT(row(viewBy("cut mesh", left), 0),
              ElementsAre(0.0F, 0.1F, 0.2F, 0.2F, 0.2F, 0.3F, 0.4F));
}

TEST(Rivals, theSheetStretchesOverHoles) {
  const std::vector<float> got = row(viewBy("sheet", {.columns = 1}), 0);
  const std::vector<float> expected = {0, 0.3F, 0.4F, 0.4F + 0.1F / 3, 0.4F + 0.2F / 3, 0.5F, 0.6F};
  for (size_t x = 0; x < got.size(); ++x) EXPECT_NEAR(got[x], expected[x], 1e-6);
}

TEST(Rivals, moveAlongColumnsAndDiagonalsAsAlongRows) {
  // Two px up: the walls of each column are flat, so only the last two rows lack a source.
  const ScoredImage below = viewBy("cut mesh", {.rows = 1});
  EXPECT_THAT(row(below, 0), ElementsAre(0.0F, 0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F));
  // Along the diagonal through the middle, column by column, as along the rows.
  for (const int sign : {1, -1}) {
    const ScoredImage corner = viewBy("cut mesh", {.columns = 1, .rows = sign});
    std::vector<float> diagonal;
    for (size_t x = 0; x < 7; ++x) {
      diagonal.push_back(row(corner, sign > 0 ? x : 6 - x)[x]);
    }
    EXPECT_THAT(diagonal, ElementsAre(0.0F, 0.3F, 0.4F, 0.5F, 0.5F, 0.5F, 0.6F));
  }
}

TEST(Mask, knowsHiddenFromOutside) {
  const test::DataSet set = twoWalls();
  const auto classes = classesOf(set, {.columns = 1}, 1);
  EXPECT_THAT(std::vector(classes.begin(), classes.begin() + 7),
              ElementsAre(kCovered, kCovered, kCovered, kHidden, kHidden, kCovered, kCovered));
  // Two rows below: the near columns come from two rows up and leave the image's end open.
  const auto from_below = classesOf(set, {.rows = 1}, 1);
  EXPECT_EQ(from_below[6 * 7 + 3], kOutside);
  EXPECT_EQ(from_below[5 * 7 + 4], kOutside);
  EXPECT_EQ(from_below[6 * 7 + 2], kCovered);
}

}  // namespace
}  // namespace viewloom::fidelity::rivals_test
