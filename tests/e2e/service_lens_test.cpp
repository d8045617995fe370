// SPDX-License-Identifier: Apache-2.0
// A lens with blades as a client asks for it, and the shape that it gives to what is out of focus.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "e2e/service_fixture.h"
#include "support/srgb_transfer.h"
#include "synthetic/synthetic_wire_frame.h"

namespace viewloom::test::service_lens_test {
namespace {

// A black wall in two halves, the left one in focus and the right one behind, with white dots.
constexpr SizePx kSource_px{320, 160};
constexpr double kFocal_px = 240;
constexpr uint32_t kNearEnd_px = 120;
constexpr float kNear_m = 2;
constexpr float kFar_m = 4;
constexpr double kAperture_m = 0.25;
// f R (1 / near - 1 / far): the radius of what a point of the far half is spread over.
constexpr double kBlur_px = kFocal_px * kAperture_m * (1 / kNear_m - 1 / kFar_m);
constexpr uint32_t kDot_px = 4;  // a side
constexpr int kAround_px = 18;   // of the middle of a dot: all that its blur reaches
constexpr uint32_t kBlades = 5;
constexpr double kRotation_rad = 0.3;

struct Dot {
  uint32_t left_px;
  uint32_t top_px;
};
// Apart by more than their blur, each in another place of the lens's pattern of 8x8 px.
constexpr Dot kFarDots[] = {{180, 30}, {225, 33},  {270, 29},  {183, 75}, {227, 78},
                            {274, 74}, {181, 119}, {222, 124}, {271, 121}};
constexpr Dot kNearDots[] = {{40, 30}, {61, 77}, {83, 118}};

WireFrame dottedFrame() {
  SyntheticLayer layer;
  for (uint32_t px = 0; px < kSource_px.area(); ++px) {
    layer.color.insert(layer.color.end(), {0, 0, 0, 255});
    layer.depth_m.push_back(px % kSource_px.width < kNearEnd_px ? kNear_m : kFar_m);
  }
  const auto draw = [&](const Dot& dot) {
    for (uint32_t i = 0; i < kDot_px * kDot_px; ++i) {
      const size_t px = (dot.top_px + i / kDot_px) * kSource_px.width + dot.left_px + i % kDot_px;
      std::fill_n(layer.color.begin() + ptrdiff_t(4 * px), 3, uint8_t{255});
    }
  };
  for (const Dot& dot : kFarDots) draw(dot);
  for (const Dot& dot : kNearDots) draw(dot);
  const Camera camera{
      .pose = {},
      .intrinsics = {.focal_px = {kFocal_px, kFocal_px},
                     .principal_px = {kSource_px.width / 2.0, kSource_px.height / 2.0}}};
  WireFrame frame;
  addLayeredSource(camera, kSource_px, {layer}, frame);
  return frame;
}

// A display with the source's own view.
v1::OpenDisplay openDots() {
  v1::OpenDisplay open;
  open.set_stream("scene");
  open.set_count(1);
  open.mutable_encoding()->set_color(v1::BAND_ENCODING_RAW);
  v1::CamerasDisplay& cameras = *open.mutable_display()->mutable_cameras();
  cameras.mutable_tile_size()->set_width(kSource_px.width);
  cameras.mutable_tile_size()->set_height(kSource_px.height);
  v1::Intrinsics& intrinsics = *cameras.add_cameras()->mutable_intrinsics();
  intrinsics.set_focal_x_px(kFocal_px);
  intrinsics.set_focal_y_px(kFocal_px);
  intrinsics.set_principal_x_px(kSource_px.width / 2.0);
  intrinsics.set_principal_y_px(kSource_px.height / 2.0);
  return open;
}

v1::LensEffect& lens(v1::OpenDisplay& open) {
  v1::LensEffect& effect = *open.mutable_display()->mutable_effects()->mutable_lens();
  effect.set_aperture_radius_m(kAperture_m);
  effect.set_focus_distance_m(kNear_m);
  effect.set_samples(64);
  effect.set_gathered_samples(256);
  return effect;
}

// In radii of the lens, to the right and up: inside a regular polygon of kBlades sides.
bool isInside(double right, double up, double rotation_rad) {
  const double side_rad = 2 * std::numbers::pi / kBlades;
  const double turn = (std::atan2(up, right) - rotation_rad) / side_rad;
  const double beside_rad = (turn - std::floor(turn) - 0.5) * side_rad;
  return std::hypot(right, up) * std::cos(beside_rad) <= std::cos(side_rad / 2);
}

// Linear light so far to the right of the middle of a dot, and below: of what is behind the focus,
// light falls where the rays pass through the lens.
double bladedLight(int right_px, int below_px, double rotation_rad) {
  constexpr int kSteps = 4;  // a px of the dot
  int lit = 0;
  for (int i = 0; i < kSteps * kSteps * int(kDot_px * kDot_px); ++i) {
    constexpr int kSide = kSteps * int(kDot_px);
    const double from_x = (i % kSide + 0.5) / kSteps - kDot_px / 2.0;
    const double from_y = (i / kSide + 0.5) / kSteps - kDot_px / 2.0;
    lit += isInside((right_px + 0.5 - from_x) / kBlur_px, -(below_px + 0.5 - from_y) / kBlur_px,
                    rotation_rad);
  }
  const double polygon =
      kBlades / 2.0 * std::sin(2 * std::numbers::pi / kBlades) * kBlur_px * kBlur_px;
  return lit / double(kSteps * kSteps) / polygon;
}

class ServiceLensTest : public ServiceFixture {
 protected:
  void SetUp() override {
    ServiceFixture::SetUp();
    if (!IsSkipped()) publishOnce(dottedFrame());
  }

  AtlasPicture pictureOf(const v1::OpenDisplay& open) {
    auto picture = decodePlane(atlasOf(open), v1::ATLAS_PLANE_COLOR);
    EXPECT_TRUE(picture.ok()) << picture.status();
    return *std::move(picture);
  }

  static int codeAt(const AtlasPicture& picture, uint32_t x, uint32_t y) {
    return picture.samples[3 * (size_t{y} * picture.width_px + x) + 1];
  }

  // Linear light, the mean of all far dots: [below][right] of their middles.
  static std::vector<double> meanDot(const AtlasPicture& picture) {
    std::vector<double> light;
    for (int below = -kAround_px; below < kAround_px; ++below) {
      for (int right = -kAround_px; right < kAround_px; ++right) {
        double sum = 0;
        for (const Dot& dot : kFarDots) {
          const uint32_t x = dot.left_px + kDot_px / 2 + uint32_t(right);
          const uint32_t y = dot.top_px + kDot_px / 2 + uint32_t(below);
          sum += linearFrom(codeAt(picture, x, y) / 255.0);
        }
        light.push_back(sum / double(std::size(kFarDots)));
      }
    }
    return light;
  }

  // Root mean square, as a share of that of the light of a lens turned like this.
  static double offFrom(const std::vector<double>& light, double rotation_rad) {
    double squares = 0;
    double expected_squares = 0;
    size_t i = 0;
    for (int below = -kAround_px; below < kAround_px; ++below) {
      for (int right = -kAround_px; right < kAround_px; ++right) {
        const double expected = bladedLight(right, below, rotation_rad);
        squares += std::pow(light[i++] - expected, 2);
        expected_squares += expected * expected;
      }
    }
    return std::sqrt(squares / expected_squares);
  }
};

TEST_F(ServiceLensTest, blursWhatIsOutOfFocusAlone) {
  v1::OpenDisplay open = openDots();
  const AtlasPicture sharp = pictureOf(open);
  lens(open).set_blades(kBlades);
  lens(open).set_rotation_rad(kRotation_rad);
  const AtlasPicture blurred = pictureOf(open);
  constexpr int kRounding = 1;       // codes
  constexpr uint32_t kSeam_px = 20;  // between the halves
  size_t in_focus_differing = 0;
  for (uint32_t y = 0; y < kSource_px.height; ++y) {
    for (uint32_t x = 0; x < kNearEnd_px - kSeam_px; ++x) {
      in_focus_differing += std::abs(codeAt(blurred, x, y) - codeAt(sharp, x, y)) > kRounding;
    }
  }
  EXPECT_EQ(in_focus_differing, 0u);
  for (const Dot& dot : kNearDots) EXPECT_EQ(codeAt(blurred, dot.left_px, dot.top_px), 255);
  for (const Dot& dot : kFarDots) {
    EXPECT_EQ(codeAt(sharp, dot.left_px, dot.top_px), 255);
    // Spread over some 500 px, light of 16 is 3 % of what it was: 48 codes.
    EXPECT_LT(codeAt(blurred, dot.left_px, dot.top_px), 80);
  }
}

TEST_F(ServiceLensTest, givesItTheShapeOfItsBladesTurnedAsAskedFor) {
  v1::OpenDisplay open = openDots();
  lens(open);
  const std::vector<double> round = meanDot(pictureOf(open));
  lens(open).set_blades(kBlades);
  lens(open).set_rotation_rad(kRotation_rad);
  const std::vector<double> bladed = meanDot(pictureOf(open));
  const double bladed_off = offFrom(bladed, kRotation_rad);
  const double mirrored_off = offFrom(bladed, -kRotation_rad);
  const double round_off = offFrom(round, kRotation_rad);
  std::cout << "off by " << bladed_off << ", from the mirrored one by " << mirrored_off
            << ", a round one by " << round_off << "\n";
  EXPECT_LT(3 * bladed_off, mirrored_off);
  EXPECT_LT(3 * bladed_off, round_off);
}

}  // namespace
}  // namespace viewloom::test::service_lens_test
