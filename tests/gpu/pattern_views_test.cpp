// SPDX-License-Identifier: Apache-2.0
// Test patterns as displays show them: what they promise each view, read off its px.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "gpu/pattern_views.h"
#include "patterns/card.h"
#include "patterns/focal_grid.h"
#include "patterns/parallax_ruler.h"
#include "support/srgb_transfer.h"

namespace viewloom::pattern_views_test {
namespace {

using patterns::PatternKind;
using patterns::PatternOptions;
using patterns::PxBox;

constexpr SizePx kSource_px{1280, 720};
// Tolerance for things that stand still on the focal plane: rounding of colours.
constexpr int kCodeTolerance = 1;

// Half the way between marks, nearly.
constexpr double kMarkReach_px = 6;

// The middle of what weight(view, x, y) finds between left and right in these rows.
template <typename Weight>
double middleOf(const PxBox& box, const Weight& weight) {
  double sum = 0, moment = 0;
  for (double y = std::ceil(box.top); y < std::floor(box.bottom); ++y) {
    for (double x = std::ceil(box.left); x < std::floor(box.right); ++x) {
      const double share = weight(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
      sum += share;
      moment += share * (x + 0.5);
    }
  }
  EXPECT_GT(sum, 0) << "nothing to measure";
  return moment / sum;
}

// Place of the red zero mark on a lighter ruler, searched around x.
double zeroMark(const ViewPicture& view, const PxBox& ruler, double x) {
  const PxBox around{x - kMarkReach_px, ruler.top + 0.75 * ruler.height(), x + kMarkReach_px,
                     ruler.bottom - 1};
  const auto green = [&](uint32_t column, uint32_t row) {
    return linearFrom(view.codeAt(column, row, 1) / 255.0);
  };
  const double paper = green(static_cast<uint32_t>(std::ceil(around.left)),
                             static_cast<uint32_t>(std::ceil(around.top)));
  return middleOf(around,
                  [&](uint32_t column, uint32_t row) { return paper - green(column, row); });
}

TEST_F(PatternViews, rulersSlideByWhatTheirLabelsSay) {
  PatternOptions options{.kind = PatternKind::kParallaxRuler, .size_px = kSource_px};
  const patterns::Pattern pattern = patternOf(options);
  const patterns::RulerPlaces places = patterns::rulerPlaces(options);
  build(pattern);
  const uint32_t left = 22, right = 26;
  const RenderedAtlas atlas =
      renderEyes(pattern, {options.views.eyeTangent(left), options.views.eyeTangent(right)});
  const ViewPicture left_view(atlas, 0), right_view(atlas, 1);
  const double f_px = pattern.camera.intrinsics.focal_px.x;
  const auto eye_m = [&](uint32_t view) {
    return kPatternFocus_m * options.views.eyeTangent(view);
  };
  for (const patterns::RulerRow& row : places.rows) {
    // Things before the plane go to the left as the eye goes to the right.
    const double px_per_m = -f_px * (row.inv_z - patterns::kFocalPlane_inv_m);
    const double middle_px = kSource_px.width / 2.0;
    const double moved_px = zeroMark(right_view, row.sliding, middle_px + px_per_m * eye_m(right)) -
                            zeroMark(left_view, row.sliding, middle_px + px_per_m * eye_m(left));
    EXPECT_NEAR(moved_px, px_per_m * (eye_m(right) - eye_m(left)), 0.05)
        << row.disparity_px << " px a view";
    // Labels are for views 560 px high and the mean way between eyes; those in the middle stand 4 %
    // closer.
    const double views_px = -row.disparity_px * (right - left) * kSource_px.height / 560.0;
    EXPECT_NEAR(moved_px, views_px, 0.05 * std::abs(views_px) + 0.05);
  }
}

// Things beside the sliding rulers are on the focal plane.
TEST_F(PatternViews, rulersOnTheFocalPlaneStandStill) {
  const PatternOptions options{.kind = PatternKind::kParallaxRuler, .size_px = kSource_px};
  const patterns::Pattern pattern = patternOf(options);
  const patterns::RulerPlaces places = patterns::rulerPlaces(options);
  build(pattern);
  const RenderedAtlas atlas =
      renderEyes(pattern, {options.views.eyeTangent(2), options.views.eyeTangent(40)});
  const ViewPicture left(atlas, 0), right(atlas, 1);
  for (const patterns::RulerRow& row : places.rows) {
    size_t differing = 0;
    for (auto x = static_cast<uint32_t>(row.sliding.left); x < row.sliding.right; ++x) {
      for (uint32_t y = 1; y < 12; ++y) {
        const uint32_t at = static_cast<uint32_t>(row.focal_ruler_top_px) + y;
        const int difference = left.codeAt(x, at, 1) - right.codeAt(x, at, 1);
        differing += std::abs(difference) > kCodeTolerance;
      }
    }
    EXPECT_EQ(differing, 0U) << row.disparity_px << " px a view";
  }
}

TEST_F(PatternViews, theGridStandsStillInEveryViewOfAQuilt) {
  const PatternOptions options{.kind = PatternKind::kFocalGrid, .size_px = kSource_px};
  const patterns::GridPlaces places = patterns::gridPlaces(options);
  build(patternOf(options));
  // By default the focal plane is off by a few ten-thousandths, which is a sixth of a px from the
  // outermost eye.
  const RenderedAtlas atlas = renderQuilt(1, 5, kSource_px, 0, kPatternFocus_m);
  const ViewPicture middle(atlas, 2);
  for (const uint32_t view : {0U, 1U, 3U, 4U}) {
    const ViewPicture picture(atlas, view);
    size_t compared = 0, differing = 0;
    for (uint32_t y = 0; y < kSource_px.height; ++y) {
      // Where slanted planes stand before the grid it is hidden.
      const bool is_beside = (y + 1 < places.turned.top || y > places.turned.bottom) &&
                             (y + 1 < places.tilted.top || y > places.tilted.bottom);
      for (uint32_t x = 0; x < kSource_px.width; ++x) {
        const bool is_far = x < places.turned.left - places.turned.width() ||
                            x > places.turned.right + places.turned.width();
        if (!is_beside && !is_far) continue;
        ++compared;
        for (int channel = 0; channel < 3; ++channel) {
          const int difference = picture.codeAt(x, y, channel) - middle.codeAt(x, y, channel);
          differing += std::abs(difference) > kCodeTolerance;
        }
      }
    }
    EXPECT_GT(compared, kSource_px.area() / 4);
    EXPECT_EQ(differing, 0U) << "view " << view;
  }
}

// Lines of the turned plane a px of disparity apart, in a row of px free of letters.
TEST_F(PatternViews, theTurnedPlanePassesThroughTheGrid) {
  PatternOptions options{.kind = PatternKind::kFocalGrid, .size_px = kSource_px};
  const patterns::Pattern pattern = patternOf(options);
  const patterns::GridPlaces places = patterns::gridPlaces(options);
  build(pattern);
  const double f_px = pattern.camera.intrinsics.focal_px.x;
  const double pitch_m = kPatternFocus_m * options.views.pitchTangent();
  const double px_per_inv_z = f_px * 560.0 / kSource_px.height * pitch_m;
  const double apart_px = 1 / (px_per_inv_z * places.inv_z_per_px);
  for (const uint32_t view : {4U, 40U}) {
    const double eye_m = kPatternFocus_m * options.views.eyeTangent(view);
    const RenderedAtlas atlas = renderEyes(pattern, {options.views.eyeTangent(view)});
    const ViewPicture picture(atlas, 0);
    for (const int disparity_px : {-1, 0, 1}) {
      const double inv_z_beside = disparity_px * apart_px * places.inv_z_per_px;
      const double expected =
          places.turned.middleX() - disparity_px * apart_px - f_px * eye_m * inv_z_beside;
      const PxBox around{expected - 5, places.turned.top + 8, expected + 5, places.turned.top + 16};
      const double found = middleOf(around, [&](uint32_t x, uint32_t y) {
        const int yellow = picture.codeAt(x, y, 0) - picture.codeAt(x, y, 2);
        return std::max(yellow, 0);
      });
      EXPECT_NEAR(found, expected, 0.3) << "view " << view << ", line " << disparity_px;
    }
  }
}

TEST_F(PatternViews, theCardComesBackPxByPx) {
  const patterns::Pattern pattern = patternOf({.kind = PatternKind::kCard, .size_px = kSource_px});
  build(pattern);
  const RenderedAtlas atlas = renderEyes(pattern, {0});
  const ViewPicture view(atlas, 0);
  size_t differing = 0;
  for (uint32_t y = 0; y < kSource_px.height; ++y) {
    for (uint32_t x = 0; x < kSource_px.width; ++x) {
      for (int channel = 0; channel < 3; ++channel) {
        const size_t at = 4 * (size_t{y} * kSource_px.width + x) + static_cast<size_t>(channel);
        differing += view.codeAt(x, y, channel) != pattern.layers.front().color[at];
      }
    }
  }
  EXPECT_EQ(differing, 0U);
}

TEST_F(PatternViews, haveTheirFocalPlaneByDefaultAndStayAsSharpAsTheyAre) {
  for (const PatternKind kind : {PatternKind::kViewNumbers, PatternKind::kParallaxRuler,
                                 PatternKind::kFocalGrid, PatternKind::kCard}) {
    for (const SizePx size_px : {kSource_px, SizePx{1920, 1080}}) {
      build(patternOf({.kind = kind, .size_px = size_px}));
      const SourceStats stats = this->stats();
      EXPECT_NEAR(contentFocalDistance(stats) / kPatternFocus_m, 1, 5e-4)
          << static_cast<int>(kind) << " at " << size_px.width;
      EXPECT_EQ(stats.smoothing_reach, 0);
      EXPECT_EQ(stats.unsorted_columns_count, 0U);
    }
  }
}

}  // namespace
}  // namespace viewloom::pattern_views_test
