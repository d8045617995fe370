// SPDX-License-Identifier: Apache-2.0
// Views from coarse depth beside those from exact depth, against the truth.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>
#include <string>

#include "gpu/true_view.h"
#include "oracle/scene_generator.h"
#include "support/test_device.h"
#include "support/truth/picture_frame.h"
#include "support/truth/scenes.h"
#include "walk/offline_renderer.h"

namespace viewloom::coarse_views_test {
namespace {

constexpr SizePx kSource_px{640, 480};
constexpr SizePx kView_px{300, 360};  // inside what the source sees
constexpr double kFocal_px = 560;
constexpr size_t kFine = 3;  // views are traced so many times finer, and averaged
constexpr double kNearest_m = 4;
constexpr double kFocalDistance_m = 8;
constexpr double kWide_px = 190;  // of disparity between what is nearest and infinity

// Losses away from edges. With smoothing 0.7 and 18.6 dB, without it 2.2 and 30.4.
constexpr double kLossOf8Bits_max_db = 1.2;
constexpr double kLossOfNoise_max_db = 21;

template <typename Value>
Value valueOrThrow(absl::StatusOr<Value> value) {
  if (!value.ok()) throw std::runtime_error(std::string(value.status().message()));
  return *std::move(value);
}

Camera sourceCamera() {
  return {.pose = {}, .intrinsics = {glm::dvec2(kFocal_px), {320, 240}}};
}

Camera viewCamera() {
  const glm::dvec2 eye_m(kWide_px * kNearest_m / kFocal_px, 0);
  const glm::dvec2 shift_px = kFocal_px / kFocalDistance_m * eye_m;
  return {.pose = {.position_m = {eye_m, 0}},
          .intrinsics = {glm::dvec2(kFocal_px), glm::dvec2(150, 180) + shift_px}};
}

DisplaySpec fineDisplay() {
  Camera camera = viewCamera();
  camera.intrinsics.focal_px *= double(kFine);
  camera.intrinsics.principal_px *= double(kFine);
  DisplaySpec spec;
  spec.kind = CamerasSpec{
      .cameras = {{camera.pose, camera.intrinsics}},
      .tile_size_px = {uint32_t(kFine) * kView_px.width, uint32_t(kFine) * kView_px.height},
      .columns = 1};
  spec.tolerance_px = double(kFine) * kDefaultTolerance_px;
  return valueOrThrow(completeDisplaySpec(spec));
}

using Change = float (*)(float inv_z, oracle::Random& random);

float exact(float inv_z, oracle::Random&) {
  return inv_z;
}

// 256 codes from infinity to what is nearest.
float in8Bits(float inv_z, oracle::Random&) {
  constexpr double kStep = 1 / kNearest_m / 255;
  return float(std::round(inv_z / kStep) * kStep);
}

// 0.4 px where what is nearest moves by 18 px.
float withNoise(float inv_z, oracle::Random& random) {
  constexpr double kSigma = 0.4 / 18 / kNearest_m;
  return float(std::max(inv_z + kSigma * random.normal(), 0.0));
}

class CoarseViewsTest : public GpuTest {
 protected:
  CoarseViewsTest()
      : scene_(truth::largeSmooth()),
        instant_(scene_, 0),
        truth_(instant_, {sourceCamera(), kSource_px, viewCamera(), kView_px}) {}

  // Away from edges, dB.
  double scoreWith(Change change) {
    truth::Picture picture = truth::takePicture(
        instant_, sourceCamera(),
        {.size_px = kSource_px, .layer_count = 3, .color = truth::ColorOver::kCenter});
    oracle::Random random(3);
    for (truth::PictureLayer& layer : picture.layers) {
      for (float& depth_m : layer.depth_m) {
        const bool is_surface = depth_m > 0 && std::isfinite(depth_m);
        if (is_surface) depth_m = 1 / change(1 / depth_m, random);
      }
    }
    OfflineRenderer& renderer = shared<OfflineRenderer>();
    renderer.build(*truth::frameOf(picture, 3));
    const RenderedAtlas atlas =
        valueOrThrow(renderer.render(fineDisplay(), {.linear = true}, [](uint32_t, uint32_t) {}));
    reach_ = renderer.stats()[0].smoothing_reach;
    return truth_.scoreInside(meanView(atlas, 0, kView_px, kFine)).full_db;
  }

  truth::Scene scene_;
  truth::Instant instant_;
  TrueView truth_;
  double reach_ = 0;
};

TEST_F(CoarseViewsTest, coarseDepthIsNearlyAsGoodAsExactDepth) {
  const double exact_db = scoreWith(exact);
  EXPECT_EQ(reach_, 0);
  const double in_8_bits_db = scoreWith(in8Bits);
  EXPECT_GT(reach_, 0);
  const double noisy_db = scoreWith(withNoise);
  EXPECT_GT(reach_, 0);
  std::cout << "away from edges, dB: exact " << exact_db << ", in 8 bits " << in_8_bits_db
            << ", with noise " << noisy_db << "\n";
  EXPECT_GE(in_8_bits_db, exact_db - kLossOf8Bits_max_db);
  EXPECT_GE(noisy_db, exact_db - kLossOfNoise_max_db);
}

}  // namespace
}  // namespace viewloom::coarse_views_test
