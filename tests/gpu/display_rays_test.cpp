// SPDX-License-Identifier: Apache-2.0
// Panels behind lenses, and px of several samples, beside what plain views of a list of cameras
// show along the same rays: those are worked out here, from the optics, one eye after the other.
#include <cmath>
#include <iostream>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "calibration/calibration.h"
#include "commands/offline_renderer.h"
#include "e2e/test_frames.h"
#include "gpu/test_device.h"
#include "support/srgb_transfer.h"

namespace viewloom {
namespace {

constexpr SizePx kSource_px{320, 180};
// Of px whose rays graze a silhouette, as rays that were rounded otherwise do.
constexpr double kTiedShareMax = 2e-3;
// Codes that rounding may move a colour by inside a surface.
constexpr int kCodeTolerance = 1;

class DisplayRays : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (IsSkipped()) return;
    renderer_.emplace(device());
    renderer_->build(*test::syntheticFrame(1, kSource_px));
  }

  RenderedAtlas render(const DisplaySpec& spec) {
    auto completed = completeDisplaySpec(spec);
    EXPECT_TRUE(completed.ok()) << completed.status();
    auto atlas = renderer_->render(*completed, {.mask = true}, [](uint32_t, uint32_t) {});
    EXPECT_TRUE(atlas.ok()) << atlas.status();
    return *std::move(atlas);
  }

  std::optional<OfflineRenderer> renderer_;
};

int channelOf(uint32_t rgba, int channel) {
  return int(rgba >> (8 * channel) & 0xff);
}

// Of all channels of all px, those that are further apart than rounding takes them.
template <typename Expected>
double differingShare(const RenderedAtlas& atlas, const Expected& expected) {
  size_t differing = 0;
  const SizePx size_px = atlas.layout->size_px;
  for (uint32_t y = 0; y < size_px.height; ++y) {
    for (uint32_t x = 0; x < size_px.width; ++x) {
      for (int channel = 0; channel < 3; ++channel) {
        const int got = channelOf(atlas.color[size_t{y} * size_px.width + x], channel);
        differing += std::abs(got - expected(x, y, channel)) > kCodeTolerance;
      }
    }
  }
  const double share = double(differing) / double(3 * size_px.area());
  std::cout << "differing share: " << share << "\n";
  return share;
}

// The colour of a px of a view of an atlas.
uint32_t colorAt(const RenderedAtlas& atlas, uint32_t view, uint32_t x, uint32_t y) {
  const TileOrigin origin = atlas.layout->tileOrigin(view);
  return atlas.color[size_t{origin.y_px + y} * atlas.layout->size_px.width + origin.x_px + x];
}

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

TEST_F(DisplayRays, showThroughEachMicrolensWhatAPinholeInItsMiddleSees) {
  const RenderedAtlas panel = render({.kind = smallPanel()});
  const RenderedAtlas pinholes = render({.kind = lensColumnsAsCameras(12)});
  const auto expected = [&](uint32_t x, uint32_t y, int channel) {
    return channelOf(pinholes.color[size_t{y} * 120 + x], channel);
  };
  EXPECT_LE(differingShare(panel, expected), kTiedShareMax);
}

TEST_F(DisplayRays, turnElementalImagesByHalfATurn) {
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
TEST_F(DisplayRays, goThroughTheMiddleOfTheirLensFromAnEyeFurtherAway) {
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

Calibration smallLenses() {
  return {.pitch = 40,
          .slope = -6.5,
          .center = 0.3,
          .view_cone_deg = 30,
          .dpi = 320,
          .screen_px = {150, 100},
          .serial = "test"};
}

// Section by section as a weaver does it: where the subpixel lies under its lens, binary64.
double viewCoordinateOf(const Calibration& lens, uint32_t x, uint32_t y, int channel) {
  const double width = lens.screen_px.width;
  const double height = lens.screen_px.height;
  const double lenses = lens.pitch * width / lens.dpi * std::cos(std::atan(1 / lens.slope));
  const double tilt = height / (width * lens.slope);
  const double u = (x + 0.5) / width;
  const double v = (height - 1 - y + 0.5) / height;
  const double phase = (u + channel / (3 * width) + v * tilt) * lenses - lens.center;
  return 1 - (phase - std::floor(phase));
}

// The views of a quilt as large as the panel, each column of px a picture of its own: what a quilt
// shows without the silhouettes that it blends between the px of a row.
CamerasSpec columnsOf(const AtlasLayout& quilt) {
  const SizePx tile_px = quilt.tile_size_px;
  CamerasSpec columns{.tile_size_px = {1, tile_px.height}, .columns = tile_px.width};
  for (const View& view : quilt.views) {
    for (uint32_t x = 0; x < tile_px.width; ++x) {
      ViewCamera camera{.pose = view.camera.pose, .projection = view.camera.intrinsics};
      std::get<Intrinsics>(camera.projection).principal_px.x -= x;
      columns.cameras.push_back(camera);
    }
  }
  return columns;
}

TEST_F(DisplayRays, weaveWhatAQuiltAsLargeAsThePanelShows) {
  constexpr uint32_t kViewCount = 6;
  LenticularSpec lenticular;
  lenticular.calibration_json = writeCalibration(smallLenses());
  lenticular.view_count = kViewCount;
  // So small that no plane stands in for facets, which views would choose each for itself.
  constexpr double kTolerance_px = 0.01;
  const RenderedAtlas panel = render({.kind = lenticular, .tolerance_px = kTolerance_px});
  const RenderedAtlas quilt =
      render({.kind = QuiltSpec{.columns = 3,
                                .rows = 2,
                                .size_px = {3 * 150, 2 * 100},
                                .view_cone_rad = 30 * std::numbers::pi / 180},
              .tolerance_px = kTolerance_px});
  const RenderedAtlas columns =
      render({.kind = columnsOf(*quilt.layout), .tolerance_px = kTolerance_px});
  const auto viewOf = [](uint32_t x, uint32_t y, int channel) {
    const double place = viewCoordinateOf(smallLenses(), x, y, channel);
    return std::min(uint32_t(place * kViewCount), kViewCount - 1);
  };
  const auto unblended = [&](uint32_t x, uint32_t y, int channel) {
    return channelOf(colorAt(columns, viewOf(x, y, channel) * 150 + x, 0, y), channel);
  };
  const auto blended = [&](uint32_t x, uint32_t y, int channel) {
    return channelOf(colorAt(quilt, viewOf(x, y, channel), x, y), channel);
  };
  EXPECT_LE(differingShare(panel, unblended), kTiedShareMax);
  // Silhouettes, which a quilt blends and subpixels do not.
  constexpr double kSilhouetteShareMax = 0.06;
  EXPECT_LE(differingShare(panel, blended), kSilhouetteShareMax);
}

class SubpixelRays : public DisplayRays, public testing::WithParamInterface<uint32_t> {};
INSTANTIATE_TEST_SUITE_P(OfViews, SubpixelRays, testing::Values(0u, 12u));

TEST_P(SubpixelRays, comeFromTheEyeThatTheLensSendsThemTo) {
  const uint32_t view_count = GetParam();
  LenticularSpec lenticular;
  lenticular.calibration_json = writeCalibration(smallLenses());
  lenticular.focal_distance_m = 2;
  lenticular.view_count = view_count;
  const RenderedAtlas panel = render({.kind = lenticular});
  const Camera middle = panel.layout->views.front().camera;
  CamerasSpec rays{.tile_size_px = {1, 1}, .columns = 32};
  struct Subpixel {
    uint32_t x, y;
    int channel;
  };
  std::vector<Subpixel> shown;
  for (uint32_t i = 0; i < 1000; ++i) {
    const Subpixel at{i * 37 % 150, i * 61 % 100, int(i % 3)};
    double place = viewCoordinateOf(smallLenses(), at.x, at.y, at.channel);
    if (view_count > 0) place = (std::floor(place * view_count) + 0.5) / view_count;
    const double eye_m = 2 * std::tan(30 * std::numbers::pi / 180 * (place - 0.5));
    ViewCamera camera;
    camera.pose.position_m = {eye_m, 0, 0};
    Intrinsics intrinsics = middle.intrinsics;
    intrinsics.principal_px.x += intrinsics.focal_px.x * eye_m / 2;
    intrinsics.principal_px -= glm::dvec2(at.x, at.y);
    camera.projection = intrinsics;
    rays.cameras.push_back(camera);
    shown.push_back(at);
  }
  const RenderedAtlas single = render({.kind = rays});
  size_t differing = 0;
  for (uint32_t i = 0; i < shown.size(); ++i) {
    const Subpixel& at = shown[i];
    const int got = channelOf(panel.color[size_t{at.y} * 150 + at.x], at.channel);
    differing += std::abs(got - channelOf(colorAt(single, i, 0, 0), at.channel)) > kCodeTolerance;
  }
  EXPECT_LE(double(differing) / double(shown.size()), kTiedShareMax);
}

// The mean, as light, of the same quilt traced from each sample's place.
TEST_F(DisplayRays, averageTheSamplesOfAPxAsLight) {
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
}  // namespace viewloom
