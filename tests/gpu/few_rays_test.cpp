// SPDX-License-Identifier: Apache-2.0
// Rows of few px, of which each ray is worked out for itself, against rows of one eye that show the
// same places; on every kind of CPU that this one can be. Needs no device.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "gpu/sweep_under_test.h"
#include "sweep/paint_kernels.h"

namespace viewloom::few_rays_test {
namespace {

constexpr uint64_t kSceneCount = 60;
constexpr double kEyeMax_px_m = 30;
// Share of px whose ray goes through an edge to within rounding, 1e-5 px of a px: one side or the
// other is seen.
constexpr double kExcusedShareMax = 1e-3;
// Rounding of inv_z: floats of about 1, through some ten operations.
constexpr float kRounding = 1e-5F;
// 1/256 px, of what rounds to the next.
constexpr int32_t kRounding_subtexels = 1;

struct PaintedPixel {
  float inv_z;
  int32_t texel;
};

// Rows of random scenes, and what views see of them.
class FewRays : public testing::Test {
 protected:
  ~FewRays() override { hwy::SetSupportedTargetsForTest(0); }

  // Calls check() with the middle row of each scene, on every kind of CPU.
  void forEachRow(const std::function<void(oracle::Random&)>& check) {
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
      SCOPED_TRACE(hwy::TargetName(target));
      hwy::SetSupportedTargetsForTest(target);
      px_count_ = hit_count_ = differing_count_ = 0;
      oracle::Random random(7);
      for (uint64_t seed = 0; seed < kSceneCount; ++seed) {
        const oracle::Scene scene = oracle::randomScene(seed);
        sweep_.prepare(frameOf(scene));
        fill_.inv_z_max = float(sweep_.source().measured().stats.inv_z_max);
        const double y_px = 0.5 * sweep_.source().sizePx().height;
        row_ = &builder_.build(sweep_.source().rowSource(), y_px, 1e-3F, float(kEyeMax_px_m));
        check(random);
      }
      EXPECT_GT(hit_count_, px_count_ / 4);
      EXPECT_LE(double(differing_count_), kExcusedShareMax * double(px_count_));
    }
  }

  std::vector<PaintedPixel> paint(const SweepView& view, uint32_t width_px) {
    Coverage coverage;
    swept_.reserve(width_px, row_->pieceCountMax());
    paintRow(*row_, view, fill_, width_px, swept_, coverage);
    std::vector<PaintedPixel> px;
    for (uint32_t p = 0; p < width_px; ++p) px.push_back({swept_.inv_z[p], swept_.texel[p]});
    return px;
  }

  // Over the whole row of the source, and a little beyond.
  SweepView randomView(oracle::Random& random, uint32_t width_px) const {
    const float side = random.uniform(-1, 1) < 0 ? -1.0F : 1.0F;
    return {.start_px = float(random.uniform(-2, 2)),
            .step_px = float(row_->width_px) / float(width_px),
            .eye_px_m = side * float(random.uniform(1, kEyeMax_px_m))};
  }

  // Places still grow from px to px at every depth, and 20 of them do not come to the source's own.
  float smallEyeStep(const SweepView& view) const {
    return std::min(0.3F * view.step_px / fill_.inv_z_max, 0.04F * std::abs(view.eye_px_m));
  }

  void compare(const PaintedPixel& px, const PaintedPixel& expected) {
    ++px_count_;
    if (expected.inv_z >= 0) ++hit_count_;
    const bool is_hole = px.inv_z < 0 && expected.inv_z < 0;
    const float error = std::abs(px.inv_z - expected.inv_z);
    const bool is_near = is_hole || error <= kRounding * (1 + std::abs(expected.inv_z));
    const bool shows_same = std::abs(px.texel - expected.texel) <= kRounding_subtexels;
    if (!is_near || !shows_same) ++differing_count_;
  }

  const SurfaceRow& row() const { return *row_; }

 private:
  SweepUnderTest sweep_;
  SurfaceRowBuilder builder_;
  const SurfaceRow* row_ = nullptr;
  SweepFill fill_;
  SweptRow swept_;
  uint64_t px_count_ = 0;
  uint64_t hit_count_ = 0;
  uint64_t differing_count_ = 0;
};

TEST_F(FewRays, seeWhatTheSameRaysSeeAmongMany) {
  forEachRow([&](oracle::Random& random) {
    const uint32_t few = std::max(row().layers[0].runs.count, 2U) - 1;
    const SweepView view = randomView(random, few);
    const std::vector<PaintedPixel> px = paint(view, few);
    const std::vector<PaintedPixel> among_many = paint(view, few + 64);
    for (uint32_t p = 0; p < few; ++p) compare(px[p], among_many[p]);
  });
}

TEST_F(FewRays, thatJumpSeeWhatBothEyesSee) {
  forEachRow([&](oracle::Random& random) {
    for (const uint32_t width_px : {3U, 14U, 40U}) {
      const SweepView first = randomView(random, width_px);
      SweepView second = first;
      second.start_px += float(random.uniform(-0.3, 0.3)) * first.step_px;
      second.eye_px_m += float(random.uniform(-1, 1)) * smallEyeStep(first);
      SweepView both = first;
      both.jump_px = std::floor(float(random.uniform(1, width_px)));
      both.jump_start_px = second.start_px - first.start_px;
      both.jump_eye_px_m = second.eye_px_m - first.eye_px_m;
      const std::vector<PaintedPixel> px = paint(both, width_px);
      const std::vector<PaintedPixel> of_first = paint(first, width_px);
      const std::vector<PaintedPixel> of_second = paint(second, width_px);
      for (uint32_t p = 0; p < width_px; ++p) {
        compare(px[p], float(p) < both.jump_px ? of_first[p] : of_second[p]);
      }
    }
  });
}

TEST_F(FewRays, fromPlacesBesideEachOtherSeeWhatEachOfTheseSees) {
  forEachRow([&](oracle::Random& random) {
    constexpr uint32_t kWidth_px = 20;
    SweepView moving = randomView(random, kWidth_px);
    moving.eye_step_px_m = float(random.uniform(-1, 1)) * smallEyeStep(moving);
    const std::vector<PaintedPixel> px = paint(moving, kWidth_px);
    for (uint32_t p = 0; p < kWidth_px; ++p) {
      SweepView still = moving;
      still.eye_step_px_m = 0;
      still.eye_px_m = moving.eyeAt(float(p));
      compare(px[p], paint(still, kWidth_px)[p]);
    }
  });
}

}  // namespace
}  // namespace viewloom::few_rays_test
