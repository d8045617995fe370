// SPDX-License-Identifier: Apache-2.0
// Lenticular panels beside what plain views of a list of cameras show along the same rays: those
// are worked out here, from the optics, one eye after the other.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "calibration/calibration.h"
#include "gpu/rendered_display.h"

namespace viewloom::lens_rays_test {
namespace {

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

TEST_F(RenderedDisplay, weaveWhatAQuiltAsLargeAsThePanelShows) {
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

class SubpixelRays : public RenderedDisplay, public testing::WithParamInterface<uint32_t> {};
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

}  // namespace
}  // namespace viewloom::lens_rays_test
