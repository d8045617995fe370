// SPDX-License-Identifier: Apache-2.0
// Panels behind microlenses, and px of several samples, beside what plain views of a list of
// cameras show along the same rays: those are worked out here, from the optics, one eye after the
// other.
#include <cmath>
#include <numbers>

#include "gpu/rendered_display.h"
#include "support/srgb_transfer.h"

namespace viewloom::display_rays_test {
namespace {

// A panel of 12 x 8 lenses of 10 px, which stands where the source's camera does.
IntegralSpec smallPanel() {
  return {
      .panel_px = {120, 80}, .pixel_pitch_m = 1e-3, .lens_pitch_m = 10e-3, .focal_length_m = 12e-3};
}

// A view for each column of each elemental image: px of a view have no neighbours in their row
// then, with which they would share a silhouette.
CamerasSpec lensColumnsAsCameras(double gap_px) {
  CamerasSpec cameras{.tile_size_px = {1, 10}, .columns = 120};
  for (int row = 0; row < 8; ++row) {
    for (int x = 0; x < 120; ++x) {
      ViewCamera camera;
      camera.pose.position_m = {(x / 10 - 5.5) * 10e-3, (3.5 - row) * 10e-3, 0};
      camera.projection =
          Intrinsics{.focal_px = {gap_px, gap_px}, .principal_px = {5.0 - x % 10, 5}};
      cameras.cameras.push_back(camera);
    }
  }
  return cameras;
}

TEST_F(RenderedDisplay, showThroughEachMicrolensWhatAPinholeInItsMiddleSees) {
  const RenderedAtlas panel = render({.kind = smallPanel()});
  const RenderedAtlas pinholes = render({.kind = lensColumnsAsCameras(12)});
  const auto expected = [&](uint32_t x, uint32_t y, int channel) {
    return channelOf(pinholes.color[size_t{y} * 120 + x], channel);
  };
  EXPECT_LE(differingShare(panel, expected), kTiedShareMax);
}

TEST_F(RenderedDisplay, turnElementalImagesByHalfATurn) {
  IntegralSpec flipped = smallPanel();
  flipped.is_flipped = true;
  const RenderedAtlas panel = render({.kind = flipped});
  const RenderedAtlas upright = render({.kind = smallPanel()});
  const auto expected = [&](uint32_t x, uint32_t y, int channel) {
    const uint32_t turned_x = x / 10 * 10 + 9 - x % 10;
    const uint32_t turned_y = y / 10 * 10 + 9 - y % 10;
    return channelOf(upright.color[size_t{turned_y} * 120 + turned_x], channel);
  };
  EXPECT_LE(differingShare(panel, expected), kTiedShareMax);
}

// The lines of sight are those of the panel held before the eye, followed back to an eye behind it.
TEST_F(RenderedDisplay, goThroughTheMiddleOfTheirLensFromAnEyeFurtherAway) {
  IntegralSpec spec = smallPanel();
  spec.panel_px = {60, 40};
  spec.distance_m = 0.4;
  spec.scale = 2;
  spec.offset_px = {3, -2};
  const RenderedAtlas panel = render({.kind = spec});
  CamerasSpec rays{.tile_size_px = {1, 1}, .columns = 60};
  const double m_per_px = 2e-3;
  std::vector<size_t> shown;  // px of the panel that rays were made for
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) {
      // Six by four lenses, moved by the offset.
      const double column = std::floor((x + 0.5 - 3) / 10);
      const double row = std::floor((y + 0.5 + 2) / 10);
      if (column < 0 || column > 5 || row < 0 || row > 3) continue;
      if ((x + y) % 3 != 0) continue;  // a third of them: as many as there may be cameras
      const double lens_x = 3 + 10 * column + 5;
      const double lens_y = -2 + 10 * row + 5;
      const double slope_x = (x + 0.5 - lens_x) / 12;
      const double slope_y = (y + 0.5 - lens_y) / 12;
      ViewCamera camera;
      camera.pose.position_m = {(lens_x - 30) * m_per_px - 0.4 * slope_x,
                                -((lens_y - 20) * m_per_px - 0.4 * slope_y), 0};
      camera.projection = Intrinsics{.focal_px = {12, 12},
                                     .principal_px = {0.5 - 12 * slope_x, 0.5 - 12 * slope_y}};
      rays.cameras.push_back(camera);
      shown.push_back(size_t(y) * 60 + size_t(x));
    }
  }
  const RenderedAtlas single = render({.kind = rays});
  size_t differing = 0;
  for (uint32_t i = 0; i < shown.size(); ++i) {
    const uint32_t expected = colorAt(single, i, 0, 0);
    for (int channel = 0; channel < 3; ++channel) {
      differing += std::abs(channelOf(panel.color[shown[i]], channel) -
                            channelOf(expected, channel)) > kCodeTolerance;
    }
  }
  EXPECT_LE(double(differing) / double(3 * shown.size()), kTiedShareMax);
  EXPECT_EQ(panel.color[0], 0xff000000u);  // left of the first lens
  EXPECT_EQ(panel.mask[0], uint8_t{0});
}

// The mean, as light, of the same quilt traced from each sample's place.
TEST_F(RenderedDisplay, averageTheSamplesOfAPxAsLight) {
  constexpr uint32_t kSampleCount = 5;
  QuiltSpec quilt{.columns = 3, .rows = 2, .size_px = {360, 160}, .focal_distance_m = 2};
  DisplaySpec spec{.kind = quilt};
  spec.filter = {.sample_count = kSampleCount, .width = 0.8};
  const RenderedAtlas filtered = render(spec);
  const AtlasLayout& layout = *filtered.layout;
  ASSERT_EQ(layout.samples.size(), kSampleCount);
  std::vector<double> light(size_t{3} * layout.size_px.area(), 0.0);
  for (const RaySample& sample : layout.samples) {
    EXPECT_LE(std::abs(sample.px.x), 0.5);
    EXPECT_LE(std::abs(sample.px.y), 0.5);
    EXPECT_LE(std::abs(sample.eye_m.x), 0.8 * layout.view_pitch_m.x / 2 * (1 + 1e-12));
    EXPECT_EQ(sample.eye_m.y, 0.0);
    CamerasSpec beside{.tile_size_px = layout.tile_size_px, .columns = 3};
    beside.order = TileOrder::kBottomLeft;
    for (const View& view : layout.views) {
      ViewCamera camera;
      camera.pose = view.camera.pose;
      camera.pose.position_m.x += sample.eye_m.x;
      Intrinsics intrinsics = view.camera.intrinsics;
      intrinsics.principal_px.x += intrinsics.focal_px.x * sample.eye_m.x / 2;
      intrinsics.principal_px -= sample.px;
      camera.projection = intrinsics;
      beside.cameras.push_back(camera);
    }
    const RenderedAtlas one = render({.kind = beside});
    for (size_t i = 0; i < one.color.size(); ++i) {
      for (int channel = 0; channel < 3; ++channel) {
        light[3 * i + size_t(channel)] +=
            linearFrom(channelOf(one.color[i], channel) / 255.0) / kSampleCount;
      }
    }
  }
  const auto expected = [&](uint32_t x, uint32_t y, int channel) {
    const size_t index = size_t{y} * layout.size_px.width + x;
    return int(std::lround(255 * srgbFrom(light[3 * index + size_t(channel)])));
  };
  EXPECT_LE(differingShare(filtered, expected), kTiedShareMax);
}

}  // namespace
}  // namespace viewloom::display_rays_test
