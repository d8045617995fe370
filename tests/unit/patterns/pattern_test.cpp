// SPDX-License-Identifier: Apache-2.0
#include "patterns/pattern.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "patterns/parallax_ruler.h"
#include "patterns/view_numbers.h"

namespace viewloom::patterns::pattern_test {
namespace {

using ::testing::HasSubstr;

constexpr PatternKind kKinds[] = {PatternKind::kViewNumbers, PatternKind::kParallaxRuler,
                                  PatternKind::kFocalGrid, PatternKind::kCard};

DisplayViews viewsOf(uint32_t count, double cone_deg = 40) {
  return {.count = count, .cone_rad = cone_deg * std::numbers::pi / 180};
}

TEST(Pattern, hasANameForEachKind) {
  for (const char* name : {"view-numbers", "parallax-ruler", "focal-grid", "card"}) {
    EXPECT_TRUE(patternFromName(name).has_value()) << name;
  }
  EXPECT_FALSE(patternFromName("cards").has_value());
}

TEST(Pattern, hasASurfaceInEveryPxAndSortedLayers) {
  for (const PatternKind kind : kKinds) {
    for (const SizePx size_px : {SizePx{1280, 720}, SizePx{720, 1280}, SizePx{960, 960}}) {
      const auto pattern = makePattern({.kind = kind, .size_px = size_px, .views = viewsOf(24)});
      ASSERT_TRUE(pattern.ok()) << pattern.status();
      ASSERT_LE(pattern->layers.size(), 2U);
      const auto& first = pattern->layers.front().depth_m;
      ASSERT_EQ(first.size(), size_px.area());
      for (size_t px = 0; px < first.size(); ++px) {
        ASSERT_GT(first[px], 0);
        if (pattern->layers.size() < 2) continue;
        const float second = pattern->layers[1].depth_m[px];
        ASSERT_TRUE(second == 0 || second >= first[px])
            << px << ": " << first[px] << ", " << second;
      }
    }
  }
}

// The server's percentiles are in bins that are even between 1 and 2 1/m: what lies evenly around
// the focal plane there has it as their mean.
TEST(Pattern, liesEvenlyAroundItsFocalPlane) {
  for (const PatternKind kind : kKinds) {
    const auto pattern = makePattern({.kind = kind});
    ASSERT_TRUE(pattern.ok()) << pattern.status();
    std::map<int, int64_t> excess;  // by 1/128 of a 1/m from the plane: px before less px behind
    size_t beyond = 0;
    for (const float depth_m : pattern->layers.front().depth_m) {
      const double beside = 1 / double{depth_m} - kFocalPlane_inv_m;
      if (std::abs(beside) < 1e-5) continue;
      if (std::abs(beside) > kDepthShareMax * kFocalPlane_inv_m + 1e-6) {
        ++beyond;
        continue;
      }
      excess[static_cast<int>(std::abs(beside) * 128)] += beside > 0 ? 1 : -1;
    }
    const auto area = static_cast<double>(pattern->size_px.area());
    for (const auto& [step, count] : excess) {
      EXPECT_LT(std::abs(static_cast<double>(count)), 0.002 * area) << step;
    }
    EXPECT_LT(static_cast<double>(beyond), 0.02 * area) << "counts as the depth of the stream";
  }
}

TEST(Pattern, refusesFramesThatAreTooSmall) {
  const auto pattern = makePattern({.kind = PatternKind::kCard, .size_px = {640, 200}});
  EXPECT_EQ(pattern.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(pattern.status().message()), HasSubstr("640x360 px and more"));
}

TEST(Pattern, refusesMoreNumbersThanFitAndSaysWhatWould) {
  PatternOptions options{.kind = PatternKind::kViewNumbers, .views = viewsOf(400)};
  const auto pattern = makePattern(options);
  EXPECT_EQ(pattern.status().code(), absl::StatusCode::kInvalidArgument);
  const std::string message(pattern.status().message());
  EXPECT_THAT(message, HasSubstr("--views 400"));
  const size_t at = message.find("frames ");
  ASSERT_NE(at, std::string::npos) << message;
  options.size_px.width = static_cast<uint32_t>(std::stoul(message.substr(at + 7)));
  EXPECT_TRUE(makePattern(options).ok()) << "what was advised works: " << message;
  EXPECT_FALSE(makePattern({.kind = PatternKind::kCard, .views = viewsOf(1)}).ok());
  EXPECT_FALSE(makePattern({.kind = PatternKind::kCard, .views = viewsOf(513)}).ok());
}

TEST(ViewNumbers, standApartOnTheStripAndInTheImage) {
  for (const uint32_t count : {2U, 9U, 45U, 48U, 100U}) {
    for (const double cone_deg : {5.0, 40.0, 90.0}) {
      const PatternOptions options{.views = viewsOf(count, cone_deg)};
      const auto places = numberPlaces(options);
      if (!places.ok()) continue;  // wide cones hold fewer
      double before = options.size_px.width;
      for (uint32_t view = 0; view < count; ++view) {
        const double middle = places->middleOnStrip(options.views.eyeTangent(view));
        EXPECT_LE(middle + places->window.width() / 2, before + 1e-6) << "the leftmost eye's right";
        before = middle - places->window.width() / 2;
      }
      EXPECT_GE(before, 0);
    }
  }
}

// The eye at x_eye sees through x_w of the plate, at z_p, the point of the strip, at z_s, at
// x_w + (x_w - x_eye) (z_s - z_p) / z_p.
TEST(ViewNumbers, standWhereTheirEyesSeeThem) {
  const PatternOptions options{.views = viewsOf(48)};
  const auto places = numberPlaces(options);
  ASSERT_TRUE(places.ok()) << places.status();
  const double z_plate = 1 / kFocalPlane_inv_m;
  const double z_strip = z_plate / kStripDepthShare;
  const double middle_px = options.size_px.width / 2.0;
  const double x_window = (places->window.middleX() - middle_px) * z_plate / places->focal_px;
  for (const uint32_t view : {0U, 13U, 47U}) {
    const double x_eye = z_plate * std::tan(options.views.angle_rad(view));
    const double x_strip = x_window + (x_window - x_eye) * (z_strip - z_plate) / z_plate;
    const double seen_px = middle_px + places->focal_px * x_strip / z_strip;
    EXPECT_NEAR(places->middleOnStrip(options.views.eyeTangent(view)), seen_px, 1e-6);
  }
}

TEST(ParallaxRuler, staysInSightOfTheSourceForAnyDisplay) {
  for (const double cone_deg : {3.0, 40.0, 110.0}) {
    for (const SizePx view_px : {SizePx{420, 560}, SizePx{4096, 2160}, SizePx{64, 64}}) {
      DisplayViews views = viewsOf(48, cone_deg);
      views.size_px = view_px;
      const PatternOptions options{.kind = PatternKind::kParallaxRuler, .views = views};
      const RulerPlaces places = rulerPlaces(options);
      ASSERT_EQ(places.rows.size(), 9U);
      for (const RulerRow& row : places.rows) {
        const double share = row.inv_z / kFocalPlane_inv_m - 1;
        EXPECT_LE(std::abs(share), kDepthShareMax + 1e-9);
        const double reach_px = places.focal_px * views.outermostTangent() * std::abs(share);
        EXPECT_GE(row.sliding.left - reach_px, 0);
      }
      EXPECT_GT(places.rows.front().disparity_px, 0);
      EXPECT_EQ(places.rows[4].disparity_px, 0);
      EXPECT_EQ(places.rows.back().disparity_px, -places.rows.front().disparity_px);
    }
  }
}

}  // namespace
}  // namespace viewloom::patterns::pattern_test
