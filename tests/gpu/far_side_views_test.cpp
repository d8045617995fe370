// SPDX-License-Identifier: Apache-2.0
// How far the far sides of one layer are taken to go on (shaders/walk.md, Far sides go on),
// judged by the true pictures of the built-in scene from the outermost views of a cone. Needs no
// device.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <iostream>
#include <numbers>

#include "scoring/image_score.h"
#include "support/test_frames.h"
#include "sweep/sweep_source.h"
#include "sweep/view_sweeper.h"
#include "synthetic/synthetic_frame.h"

namespace viewloom::test::far_side_views_test {
namespace {

constexpr SizePx kView_px{480, 360};
constexpr uint32_t kViewCount = 2;

DisplaySpec outermostViews(double cone_deg) {
  DisplaySpec spec;
  spec.kind = QuiltSpec{.columns = kViewCount,
                        .rows = 1,
                        .size_px = {kViewCount * kView_px.width, kView_px.height},
                        .aspect = double(kView_px.width) / kView_px.height,
                        .view_cone_rad = cone_deg * std::numbers::pi / 180,
                        .view_count = kViewCount};
  return completeDisplaySpec(spec).value();
}

// Opaque R, G, B, 255 in memory order.
ScoredImage scoredView(const uint8_t* rgba, size_t stride_px) {
  ScoredImage image{kView_px, {}};
  for (size_t row = 0; row < kView_px.height; ++row) {
    for (size_t i = 0; i < 4 * size_t{kView_px.width}; ++i) {
      if (i % 4 != 3) image.rgb.push_back(float(rgba[4 * row * stride_px + i]) / 255);
    }
  }
  return image;
}

class FarSideViewsTest : public testing::Test {
 protected:
  FarSideViewsTest() { source_.prepare(syntheticFrame(1, kView_px, 1), workers_); }

  // PSNR of each view, dB, of the px that the source's image reaches.
  std::array<double, kViewCount> score(double cone_deg, SweepFault fault) {
    const DisplaySpec spec = outermostViews(cone_deg);
    const StreamDefaults defaults{
        .source_intrinsics = source_.camera().intrinsics,
        .source_size_px = source_.sizePx(),
        .focal_distance_m = contentFocalDistance(source_.measured().stats)};
    const auto layout =
        std::make_shared<const AtlasLayout>(makeAtlasLayout(spec, defaults).value());
    const TraceJob job = makeTraceJob(layout, spec, displayPose(spec, source_.camera()),
                                      source_.camera(), source_.sizePx());
    const double inv_z_max = source_.measured().stats.inv_z_max;
    const SweepPlan plan = SweepPlan::make(job, inv_z_max).value();
    RowSource rows = source_.rowSource();
    rows.planted_fault = fault;
    const TraceOutputs outputs{.mask = true};
    SweptAtlas atlas;
    atlas.begin(job, outputs);
    ViewSweeper().sweepRows(
        {.job = &job, .plan = &plan, .source = rows, .inv_z_max = float(inv_z_max)}, 0,
        plan.rowCount(), outputs, atlas);
    std::array<double, kViewCount> psnr_db{};
    for (uint32_t view = 0; view < kViewCount; ++view) {
      psnr_db[view] = scoreView(*layout, view, atlas);
    }
    return psnr_db;
  }

 private:
  static double scoreView(const AtlasLayout& layout, uint32_t view, const SweptAtlas& atlas) {
    const size_t stride_px = layout.size_px.width;
    const size_t first_px = size_t{layout.tileOrigin(view).x_px};
    std::vector<uint8_t> is_seen;
    for (size_t row = 0; row < kView_px.height; ++row) {
      for (size_t column = 0; column < kView_px.width; ++column) {
        is_seen.push_back(atlas.mask[row * stride_px + first_px + column] != abi::kClassOutside);
      }
    }
    const auto true_layers =
        renderSyntheticFrame({.size_px = kView_px, .camera = layout.views[view].camera});
    const auto* const rgba = reinterpret_cast<const uint8_t*>(atlas.color.data() + first_px);
    return ImageComparison(scoredView(rgba, stride_px),
                           scoredView(true_layers[0].color.data(), kView_px.width),
                           ScoreTransfer::kSrgb)
        .score(is_seen, is_seen.size())
        .psnr_db;
  }

  WorkerPool workers_{2};
  SweepSource source_;
};

TEST_F(FarSideViewsTest, areBestOfAWideConeWhereFarSidesGoOnAsFarAsTheyReach) {
  constexpr double kWide_deg = 40;
  for (const double cone_deg : {10.0, 25.0, kWide_deg}) {
    const auto reaching = score(cone_deg, SweepFault::kNone);
    const auto endless = score(cone_deg, SweepFault::kFarSideEndless);
    const auto ending = score(cone_deg, SweepFault::kFarSideEnds);
    std::cout << cone_deg << " degrees, left / right view, dB: as far as they reach " << reaching[0]
              << " / " << reaching[1] << ", without an end " << endless[0] << " / " << endless[1]
              << ", not at all " << ending[0] << " / " << ending[1] << "\n";
    if (cone_deg < kWide_deg) continue;
    EXPECT_GT(reaching[0] + reaching[1], endless[0] + endless[1]);
    EXPECT_GT(reaching[0] + reaching[1], ending[0] + ending[1]);
  }
}

}  // namespace
}  // namespace viewloom::test::far_side_views_test
