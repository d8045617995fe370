// SPDX-License-Identifier: Apache-2.0
// The cameras of quilts, stereo pairs and camera lists, judged by projecting points through them.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "display/atlas_layout.h"

namespace viewloom::display_views_test {
namespace {

// Textbook pinhole: where a point in front of the display falls in a view's tile, px.
glm::dvec2 project(const View& view, const glm::dvec3& point_m) {
  const glm::dvec3 p =
      glm::inverse(view.camera.pose.orientation) * (point_m - view.camera.pose.position_m);
  const Intrinsics& k = view.camera.intrinsics;
  return {k.principal_px.x + k.focal_px.x * p.x / -p.z,
          k.principal_px.y - k.focal_px.y * p.y / -p.z};
}

// A source whose axis does not pass through the middle of its image.
StreamDefaults offAxisStream() {
  StreamDefaults stream;
  stream.source_intrinsics = {.focal_px = {900, 1000}, .principal_px = {700, 500}};
  stream.source_size_px = {1280, 720};
  stream.focal_distance_m = 2.5;
  return stream;
}

QuiltSpec anamorphicQuilt() {
  return {.columns = 8, .rows = 6, .size_px = {7680, 4320}, .aspect = 16.0 / 9.0};
}

AtlasLayout layoutOf(const DisplaySpec& spec, const StreamDefaults& stream) {
  const absl::StatusOr<DisplaySpec> completed = completeDisplaySpec(spec);
  EXPECT_TRUE(completed.ok()) << completed.status();
  const absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(*completed, stream);
  EXPECT_TRUE(layout.ok()) << layout.status();
  return *layout;
}

// Rounding of a handful of binary64 operations on numbers up to 1e5 px.
constexpr double kRounding_px = 1e-9;

TEST(QuiltViews, showEveryPointOfTheFocalPlaneAtTheSamePixel) {
  const AtlasLayout layout = layoutOf({.kind = anamorphicQuilt()}, offAxisStream());
  ASSERT_EQ(layout.views.size(), 48u);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> offset_m(-3, 3);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 point_m(offset_m(random), offset_m(random), -2.5);
    const glm::dvec2 expected_px = project(layout.views[0], point_m);
    for (const View& view : layout.views) {
      const glm::dvec2 got_px = project(view, point_m);
      ASSERT_NEAR(got_px.x, expected_px.x, kRounding_px);
      ASSERT_NEAR(got_px.y, expected_px.y, kRounding_px);
    }
  }
}

TEST(QuiltViews, lookStraightAheadFromALine) {
  const AtlasLayout layout = layoutOf({.kind = anamorphicQuilt()}, offAxisStream());
  for (const View& view : layout.views) {
    EXPECT_EQ(view.camera.pose.orientation, Pose{}.orientation);
    EXPECT_EQ(view.camera.pose.position_m.y, 0);
    EXPECT_EQ(view.camera.pose.position_m.z, 0);
  }
}

TEST(QuiltViews, goFromLeftToRightInEqualSharesOfTheCone) {
  QuiltSpec quilt = anamorphicQuilt();
  quilt.view_cone_rad = 0.8;
  const AtlasLayout layout = layoutOf({.kind = quilt}, offAxisStream());
  const auto angleOf = [&](size_t i) {
    return std::atan(layout.views[i].camera.pose.position_m.x / 2.5);
  };
  EXPECT_NEAR(angleOf(0), -0.4 + 0.8 / 96, 1e-12);
  EXPECT_NEAR(angleOf(47), 0.4 - 0.8 / 96, 1e-12);
  for (size_t i = 1; i < 48; ++i) EXPECT_NEAR(angleOf(i) - angleOf(i - 1), 0.8 / 48, 1e-12);
}

TEST(QuiltViews, moveNearPointsAgainstTheEye) {
  const AtlasLayout layout = layoutOf({.kind = anamorphicQuilt()}, offAxisStream());
  const glm::dvec3 near_m(0, 0, -1);
  EXPECT_GT(project(layout.views.front(), near_m).x, project(layout.views.back(), near_m).x);
}

TEST(QuiltViews, cropTheSourceToTheirAspectAroundItsMiddle) {
  const StreamDefaults stream = offAxisStream();
  QuiltSpec quilt = {.columns = 1, .rows = 1, .size_px = {300, 400}};
  const AtlasLayout layout = layoutOf({.kind = quilt}, stream);
  // One view stands in the source: its tile corners are image points of the source.
  const Intrinsics& view = layout.views[0].camera.intrinsics;
  const Intrinsics& source = stream.source_intrinsics;
  const auto inSource = [&](glm::dvec2 tile_px) {
    return (tile_px - view.principal_px) / view.focal_px * source.focal_px + source.principal_px;
  };
  const glm::dvec2 top_left = inSource({0, 0});
  const glm::dvec2 bottom_right = inSource({300, 400});
  EXPECT_NEAR(top_left.y, 0, kRounding_px);
  EXPECT_NEAR(bottom_right.y, 720, kRounding_px);
  EXPECT_NEAR(top_left.x + bottom_right.x, 1280, kRounding_px);
  // 720 rows at 1000 px focal length are 0.72 high per metre; three quarters of it at 900 px wide.
  EXPECT_NEAR(bottom_right.x - top_left.x, 0.72 * 0.75 * 900, kRounding_px);
}

TEST(QuiltViews, returnTheSourceCameraForASingleTileOfItsSize) {
  StreamDefaults stream = offAxisStream();
  stream.source_intrinsics.focal_px = {1000, 1000};
  const AtlasLayout layout =
      layoutOf({.kind = QuiltSpec{.columns = 1, .rows = 1, .size_px = {1280, 720}}}, stream);
  const Camera& camera = layout.views[0].camera;
  EXPECT_EQ(camera.pose, Pose{});
  EXPECT_NEAR(camera.intrinsics.focal_px.x, 1000, kRounding_px);
  EXPECT_NEAR(camera.intrinsics.focal_px.y, 1000, kRounding_px);
  EXPECT_NEAR(camera.intrinsics.principal_px.x, 700, kRounding_px);
  EXPECT_NEAR(camera.intrinsics.principal_px.y, 500, kRounding_px);
}

TEST(QuiltViews, takeAGivenFieldOfViewAroundTheAxis) {
  QuiltSpec quilt = anamorphicQuilt();
  quilt.fov_y_rad = std::numbers::pi / 2;
  quilt.focal_distance_m = 3;
  const AtlasLayout layout = layoutOf({.kind = quilt}, offAxisStream());
  for (const View& view : layout.views) {  // tan(45 deg) = 1: 6 m high, 16/9 of it wide
    EXPECT_NEAR(project(view, {0, 3, -3}).y, 0, kRounding_px);
    EXPECT_NEAR(project(view, {0, -3, -3}).y, 720, kRounding_px);
    EXPECT_NEAR(project(view, {-16.0 / 3, 0, -3}).x, 0, kRounding_px);
    EXPECT_NEAR(project(view, {16.0 / 3, 0, -3}).x, 960, kRounding_px);
  }
}

TEST(QuiltViews, stayFiniteForAStreamOfSkyOrGarbage) {
  for (const double distance_m : {std::numeric_limits<double>::infinity(), 0.0, -1.0,
                                  std::numeric_limits<double>::quiet_NaN()}) {
    StreamDefaults stream = offAxisStream();
    stream.focal_distance_m = distance_m;
    const AtlasLayout layout = layoutOf({.kind = anamorphicQuilt()}, stream);
    EXPECT_GE(layout.focal_distance_m, kFocalDistanceMin_m);
    EXPECT_LE(layout.focal_distance_m, kFocalDistanceMax_m);
  }
}

TEST(StereoViews, standHalfTheEyeDistanceToEachSideAndAgreeOnTheFocalPlane) {
  const StereoSpec stereo = {.eye_size_px = {640, 360}, .eye_distance_m = 0.06};
  const AtlasLayout layout = layoutOf({.kind = stereo}, offAxisStream());
  ASSERT_EQ(layout.views.size(), 2u);
  EXPECT_DOUBLE_EQ(layout.views[0].camera.pose.position_m.x, -0.03);
  EXPECT_DOUBLE_EQ(layout.views[1].camera.pose.position_m.x, 0.03);
  const glm::dvec3 on_plane_m(0.4, -0.3, -2.5);
  EXPECT_NEAR(project(layout.views[0], on_plane_m).x, project(layout.views[1], on_plane_m).x,
              kRounding_px);
  // A point at infinity: disparity = focal * baseline / focal distance, the left eye's image left.
  const glm::dvec3 far_m(0, 0, -1e12);
  EXPECT_NEAR(project(layout.views[1], far_m).x - project(layout.views[0], far_m).x,
              layout.views[0].camera.intrinsics.focal_px.x * 0.06 / 2.5, 1e-6);
}

TEST(StereoViews, areTheGivenCameras) {
  StereoSpec stereo = {.eye_size_px = {100, 100}};
  stereo.eyes.resize(2, {.projection = Intrinsics{{80, 80}, {50, 50}}});
  stereo.eyes[1].pose.position_m.x = 0.2;
  const AtlasLayout layout = layoutOf({.kind = stereo}, offAxisStream());
  EXPECT_EQ(layout.views[0].camera.intrinsics, (Intrinsics{{80, 80}, {50, 50}}));
  EXPECT_EQ(layout.views[1].camera.pose.position_m.x, 0.2);
  EXPECT_EQ(layout.view_pitch_m, glm::dvec2(0.2, 0));
}

TEST(CameraViews, turnAnglesIntoTilePixels) {
  const double quarter = std::numbers::pi / 4;
  const CamerasSpec cameras = {
      .cameras = {{.projection = Fov{-quarter, quarter, quarter, -quarter}}},
      .tile_size_px = {200, 100}};
  const AtlasLayout layout = layoutOf({.kind = cameras}, offAxisStream());
  EXPECT_NEAR(project(layout.views[0], {-1, 1, -1}).x, 0, kRounding_px);
  EXPECT_NEAR(project(layout.views[0], {-1, 1, -1}).y, 0, kRounding_px);
  EXPECT_NEAR(project(layout.views[0], {1, -1, -1}).x, 200, kRounding_px);
  EXPECT_NEAR(project(layout.views[0], {1, -1, -1}).y, 100, kRounding_px);
}

TEST(QuiltViews, standWhereEachConventionHasThem) {
  QuiltSpec quilt{.columns = 3, .rows = 1, .size_px = {300, 100}, .view_cone_rad = 0.6};
  quilt.focal_distance_m = 2;
  quilt.depthiness = 1.25;
  const auto eyes = [&](CameraConvention convention) {
    quilt.convention = convention;
    std::vector<double> x_m;
    for (const View& view : layoutOf({.kind = quilt}, offAxisStream()).views) {
      x_m.push_back(view.camera.pose.position_m.x);
    }
    return x_m;
  };
  // Thirds of 0.75 rad, from their middles; halves of it, from its edges; and evenly along tan 0.6.
  const double third_m = 2 * std::tan(0.25);
  const double half_m = 2 * std::tan(0.375);
  const double even_m = 2 * 1.25 * std::tan(0.6) / 2;
  const auto near = [](double x_m) { return testing::DoubleNear(x_m, 1e-12); };
  EXPECT_THAT(eyes(CameraConvention::kWebxr),
              testing::ElementsAre(near(-third_m), near(0), near(third_m)));
  EXPECT_THAT(eyes(CameraConvention::kCore),
              testing::ElementsAre(near(-half_m), near(0), near(half_m)));
  EXPECT_THAT(eyes(CameraConvention::kBridge),
              testing::ElementsAre(near(-even_m), near(0), near(even_m)));
}

TEST(QuiltViews, ofAPartOfTheConeStandWhereTheWholeHasThem) {
  const QuiltSpec whole{.columns = 8, .rows = 6, .size_px = {3360, 3360}, .aspect = 0.75};
  const AtlasLayout all = layoutOf({.kind = whole}, offAxisStream());
  for (const auto& [first, count] : {std::pair<uint32_t, uint32_t>{20, 5}, {0, 3}, {47, 1}}) {
    const QuiltSpec few{.columns = count,
                        .rows = 1,
                        .size_px = {420 * count, 560},
                        .aspect = 0.75,
                        .cone_begin = first / 48.0,
                        .cone_end = (first + count) / 48.0};
    const AtlasLayout part = layoutOf({.kind = few}, offAxisStream());
    ASSERT_EQ(part.views.size(), count);
    for (uint32_t view = 0; view < count; ++view) {
      const Camera& camera = part.views[view].camera;
      const Camera& expected = all.views[first + view].camera;
      EXPECT_NEAR(camera.pose.position_m.x, expected.pose.position_m.x, 1e-12);
      EXPECT_NEAR(camera.intrinsics.focal_px.x, expected.intrinsics.focal_px.x, 1e-9);
      EXPECT_NEAR(camera.intrinsics.principal_px.x, expected.intrinsics.principal_px.x, 1e-9);
    }
    // Neighbours are as far apart, also from one that stands alone: a lens is as wide.
    EXPECT_NEAR(part.view_pitch_m.x, all.view_pitch_m.x, 0.2 * all.view_pitch_m.x);
    EXPECT_EQ(part.view_cone_rad, all.view_cone_rad);
  }
}

TEST(CameraGrid, countsItsEyesFromTheLeftAndAsItsTilesAre) {
  CamerasSpec cameras{.tile_size_px = {40, 30}};
  cameras.grid = CameraGrid{.columns = 3, .rows = 2, .spacing_m = {0.1, 0.2}};
  const AtlasLayout from_top = layoutOf({.kind = cameras}, offAxisStream());
  ASSERT_EQ(from_top.views.size(), 6u);
  EXPECT_EQ(from_top.columns, 3u);
  EXPECT_NEAR(from_top.views[0].camera.pose.position_m.x, -0.1, 1e-12);
  EXPECT_NEAR(from_top.views[0].camera.pose.position_m.y, 0.1, 1e-12);
  EXPECT_NEAR(from_top.views[5].camera.pose.position_m.x, 0.1, 1e-12);
  EXPECT_NEAR(from_top.views[5].camera.pose.position_m.y, -0.1, 1e-12);
  cameras.order = TileOrder::kBottomLeft;
  EXPECT_NEAR(layoutOf({.kind = cameras}, offAxisStream()).views[0].camera.pose.position_m.y, -0.1,
              1e-12);
  // All frame one rectangle of the focal plane.
  const glm::dvec3 point_m(0.3, -0.2, -from_top.focal_distance_m);
  for (const View& view : from_top.views) {
    EXPECT_NEAR(project(view, point_m).x, project(from_top.views[0], point_m).x, kRounding_px);
    EXPECT_NEAR(project(view, point_m).y, project(from_top.views[0], point_m).y, kRounding_px);
  }
}

TEST(CameraGrid, liesAsItIsArranged) {
  CamerasSpec cameras{.tile_size_px = {40, 30}};
  cameras.grid = CameraGrid{.columns = 2, .rows = 2};
  const auto sizeOf = [&](TileArrangement arrangement) {
    cameras.arrangement = arrangement;
    return layoutOf({.kind = cameras}, offAxisStream()).size_px;
  };
  EXPECT_EQ(sizeOf(TileArrangement::kGrid), (SizePx{80, 60}));
  EXPECT_EQ(sizeOf(TileArrangement::kRow), (SizePx{160, 30}));
  EXPECT_EQ(sizeOf(TileArrangement::kQuad), (SizePx{80, 60}));
  EXPECT_EQ(sizeOf(TileArrangement::kSeparate), (SizePx{40, 120}));
  EXPECT_EQ(layoutOf({.kind = cameras}, offAxisStream()).image_count, 4u);
}

}  // namespace
}  // namespace viewloom::display_views_test
