// SPDX-License-Identifier: Apache-2.0
// Each view sees its own number through the window, and no other.
#include <gtest/gtest.h>

#include <optional>
#include <utility>
#include <vector>

#include "gpu/pattern_views.h"
#include "patterns/view_numbers.h"
#include "support/read_view_number.h"

namespace viewloom::view_numbers_test {
namespace {

using patterns::PatternKind;
using patterns::PatternOptions;
using patterns::PxBox;

constexpr SizePx kSource_px{1280, 720};

// Tiles show the source at `scale` around its middle.
std::optional<uint32_t> numberIn(const ViewPicture& view, const PxBox& window, double scale) {
  return test::readViewNumber(window, kSource_px, view.sizePx(), scale,
                              [&](uint32_t x, uint32_t y) { return view.codeAt(x, y, 1) > 127; });
}

constexpr uint32_t kColumns = 8, kRows = 3, kViews = kColumns * kRows;
constexpr SizePx kTile_px{216, 288};

class ViewNumbers : public PatternViews {
 protected:
  // Number in each view of a quilt of kViews.
  std::vector<std::optional<uint32_t>> readQuilt(const PxBox& window) {
    const RenderedAtlas atlas = renderQuilt(kColumns, kRows, kTile_px, 0.75);
    std::vector<std::optional<uint32_t>> numbers;
    for (uint32_t view = 0; view < kViews; ++view) {
      const double scale = double{1} * kTile_px.height / kSource_px.height;
      numbers.push_back(numberIn(ViewPicture(atlas, view), window, scale));
    }
    return numbers;
  }

  static PatternOptions numbersOf(uint32_t view_count) {
    PatternOptions options{.kind = PatternKind::kViewNumbers, .size_px = kSource_px};
    options.views.count = view_count;
    return options;
  }

  static std::vector<std::optional<uint32_t>> inOrder() {
    std::vector<std::optional<uint32_t>> numbers(kViews);
    for (uint32_t view = 0; view < kViews; ++view) numbers[view] = view;
    return numbers;
  }
};

TEST_F(ViewNumbers, eachViewOfAQuiltShowsItsOwn) {
  const PatternOptions options = numbersOf(kViews);
  build(patternOf(options));
  EXPECT_EQ(readQuilt(patterns::numberPlaces(options)->window), inOrder());
}

TEST_F(ViewNumbers, fitInAWideFrameUpTo100) {
  const PatternOptions options{
      .kind = PatternKind::kViewNumbers, .size_px = {2400, 1350}, .views = {.count = 100}};
  const patterns::Pattern pattern = patternOf(options);
  const PxBox window = patterns::numberPlaces(options)->window;
  build(pattern);
  for (const uint32_t view : {0U, 31U, 50U, 99U}) {
    const RenderedAtlas atlas = renderEyes(pattern, {options.views.eyeTangent(view)});
    // Around the middle of its own frame, as if it were that of the others.
    PxBox moved = window;
    moved.left += (kSource_px.width - 2400.0) / 2;
    moved.right += (kSource_px.width - 2400.0) / 2;
    moved.top += (kSource_px.height - 1350.0) / 2;
    EXPECT_EQ(numberIn(ViewPicture(atlas, 0), moved, 1), view);
  }
}

// The purpose of the pattern: eyes that are not where the display says.
TEST_F(ViewNumbers, areOthersForEyesOneViewToTheSide) {
  const PatternOptions options = numbersOf(kViews);
  const patterns::Pattern pattern = patternOf(options);
  build(pattern);
  const RenderedAtlas atlas =
      renderEyes(pattern, {options.views.eyeTangent(11), options.views.eyeTangent(12)});
  const PxBox window = patterns::numberPlaces(options)->window;
  EXPECT_EQ(numberIn(ViewPicture(atlas, 0), window, 1), 11U);
  EXPECT_EQ(numberIn(ViewPicture(atlas, 1), window, 1), 12U);
  build(patternOf(numbersOf(kViews - 1)));
  EXPECT_NE(readQuilt(patterns::numberPlaces(numbersOf(kViews - 1))->window), inOrder());
}

TEST_F(ViewNumbers, cannotBeReadMirrored) {
  const PatternOptions options = numbersOf(kViews);
  patterns::Pattern pattern = patternOf(options);
  for (SyntheticLayer& layer : pattern.layers) {
    SyntheticLayer mirrored = layer;
    for (size_t px = 0; px < layer.depth_m.size(); ++px) {
      const size_t x = px % kSource_px.width;
      const size_t from = px - x + kSource_px.width - 1 - x;
      layer.depth_m[px] = mirrored.depth_m[from];
      for (size_t i = 0; i < 4; ++i) layer.color[4 * px + i] = mirrored.color[4 * from + i];
    }
  }
  build(std::move(pattern));
  for (const auto& number : readQuilt(patterns::numberPlaces(options)->window)) {
    EXPECT_FALSE(number.has_value());
  }
}

}  // namespace
}  // namespace viewloom::view_numbers_test
