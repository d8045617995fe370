// SPDX-License-Identifier: Apache-2.0
// Mirrors through a lens, beside the mean of single rays that mirror, too.
#include <memory>

#include "gpu/through_lens.h"
#include "gpu/world_views.h"
#include "support/truth/mirror_scenes.h"
#include "support/truth/picture_frame.h"

namespace viewloom::lens_mirrors_test {
namespace {

class LensMirrors : public ThroughLens {
 protected:
  void SetUp() override {
    ThroughLens::SetUp();
    if (IsSkipped()) return;
    build(0);
  }

  void build(double roughness) {
    const Camera camera{.intrinsics = {glm::dvec2(160), {160, 90}}};
    one_ = truth::frameOf(truth::takePicture(truth::Instant(truth::mirrorFloor(roughness), 0),
                                             camera, {.size_px = kSource_px, .layer_count = 2}),
                          2);
    renderer_->build(*one_);
  }

  static DisplaySpec mirrored() {
    ViewCamera camera;
    camera.pose.position_m = {0.02, 0.01, 0};
    camera.projection = Intrinsics{.focal_px = {100, 100}, .principal_px = {80, 50}};
    DisplaySpec spec{.kind = CamerasSpec{.cameras = {camera}, .tile_size_px = {160, 120}},
                     .tolerance_px = kTolerance_px,
                     .reflection = ReflectionSpec{.bounce_count = 2, .is_unfiltered = true}};
    spec.lens = walkedLens();
    spec.lens->aperture_radius_m = 0.1;  // wide enough that one eye for all rays is found out
    return spec;
  }

  FramePtr one_;
};

TEST_F(LensMirrors, showTheMeanOfWhatTheRaysOfALensFind) {
  EXPECT_LE(differingOf(mirrored(), 0), kTiedShareMax);
}

TEST_F(LensMirrors, showItInSeveralSources) {
  renderer_->build(*twice(*one_));
  EXPECT_LE(differingOf(mirrored(), 0), kTiedShareMax);
}

// Each ray of a px spreads its reflected rays its own way: alike, many would be as noisy as one.
TEST_F(LensMirrors, areLessNoisyTheMoreRaysAPxHas) {
  build(0.4);
  DisplaySpec spec = mirrored();
  spec.lens->aperture_radius_m = 1e-4;  // all see the same
  const auto picture = [&](uint32_t walked_count, uint32_t reflected_count) {
    spec.lens->walked_count = walked_count;
    spec.reflection->sample_count = reflected_count;
    return render(spec);
  };
  const RenderedAtlas smooth = picture(16, 64);
  const double few_codes = differenceOf(picture(1, 4), smooth);
  const double many_codes = differenceOf(picture(16, 4), smooth);
  const double as_many_codes = differenceOf(picture(1, 64), smooth);
  std::cout << "rms " << few_codes << ", " << many_codes << " of 16 times as many, and "
            << as_many_codes << " of as many at once\n";
  EXPECT_LT(many_codes, 0.5 * few_codes);
}

// Mirrors are of the walked rays alone, and so is the picture.
TEST_F(LensMirrors, haveNoSecondStage) {
  DisplaySpec spec = mirrored();
  const RenderedAtlas walked = render(spec);
  spec.lens->gathered_count = 32;
  EXPECT_EQ(render(spec).color, walked.color);
  spec.reflection.reset();
  EXPECT_NE(render(spec).color, walked.color);
}

TEST_F(LensMirrors, leaveTheMaskToTheRayThroughTheMiddle) {
  DisplaySpec spec = mirrored();
  const RenderedAtlas blurred = render(spec);
  spec.lens.reset();
  const RenderedAtlas sharp = render(spec);
  EXPECT_EQ(blurred.mask, sharp.mask);
  EXPECT_NE(blurred.color, sharp.color);
}

}  // namespace
}  // namespace viewloom::lens_mirrors_test
