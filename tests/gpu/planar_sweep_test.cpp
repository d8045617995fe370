// SPDX-License-Identifier: Apache-2.0
// Atlases swept as Y'CbCr are judged by the same atlas in RGB and libjpeg-turbo's conversion.
#include <gtest/gtest.h>

#include "support/test_frames.h"
#include "support/ycbcr_planes.h"
#include "sweep/sweep_source.h"
#include "sweep/view_sweeper.h"

namespace viewloom::test::planar_sweep_test {
namespace {

constexpr SizePx kSource_px{160, 90};
constexpr TraceOutputs kRgb{.mask = true};

// Atlases of 4x2 tiles, in the layout of smallQuilt(): even and odd heights of tiles, paddings
// above and to the right, and widths.
const std::vector<SizePx> kAtlases_px = {{256, 128}, {260, 126}, {252, 142}, {258, 143},
                                         {263, 129}, {331, 205}, {36, 34},   {8, 2},
                                         {12, 3},    {4, 5},     {20, 6},    {1282, 11}};

DisplaySpec quilt(SizePx size_px) {
  DisplaySpec spec = smallQuilt(size_px);
  std::get<QuiltSpec>(spec.kind).view_count = 7;  // one tile is black
  spec.outside_fill = OutsideFill::kBackground;
  spec.background_rgb = 0xE04080;
  return spec;
}

class PlanarSweepTest : public testing::Test {
 protected:
  PlanarSweepTest() { source_.prepare(syntheticFrame(1, kSource_px, 2), workers_); }

  TraceJob jobOf(const DisplaySpec& spec) const {
    const StreamDefaults defaults{
        .source_intrinsics = source_.camera().intrinsics,
        .source_size_px = source_.sizePx(),
        .focal_distance_m = contentFocalDistance(source_.measured().stats)};
    const auto layout =
        std::make_shared<const AtlasLayout>(makeAtlasLayout(spec, defaults).value());
    return makeTraceJob(layout, spec, displayPose(spec, source_.camera()), source_.camera(),
                        source_.sizePx());
  }

  // In pieces of so many rows, from the last to the first, into memory of an older atlas.
  Coverage sweep(const TraceJob& job, const TraceOutputs& outputs, uint32_t rows_per_piece) {
    const double inv_z_max = source_.measured().stats.inv_z_max;
    const SweepPlan plan = SweepPlan::make(job, inv_z_max).value();
    atlas_.begin(job, outputs);
    Coverage coverage;
    for (uint32_t piece = (plan.rowCount() + rows_per_piece - 1) / rows_per_piece; piece-- > 0;) {
      const uint32_t first = piece * rows_per_piece;
      coverage.add(sweeper_.sweepRows({.job = &job,
                                       .plan = &plan,
                                       .source = source_.rowSource(),
                                       .inv_z_max = float(inv_z_max)},
                                      first, std::min(rows_per_piece, plan.rowCount() - first),
                                      outputs, atlas_));
    }
    return coverage;
  }

  WorkerPool workers_{2};
  SweepSource source_;
  ViewSweeper sweeper_;
  SweptAtlas atlas_;
};

TEST_F(PlanarSweepTest, givesThePlanesOfTheWholeAtlasHoweverRowsAreShared) {
  for (const SizePx size_px : kAtlases_px) {
    const TraceJob job = jobOf(quilt(size_px));
    ASSERT_EQ(job.layout->size_px, size_px);
    const Coverage coverage = sweep(job, kRgb, 8);
    const std::vector<uint32_t> rgb = atlas_.color;
    const std::vector<uint8_t> mask = atlas_.mask;
    for (const ColorForm form : {ColorForm::kYcbcr420, ColorForm::kYcbcr444}) {
      const std::vector<uint8_t> expected = ycbcrPlanesOf(rgb, size_px, form);
      for (const uint32_t rows_per_piece : {1U, 2U, 3U, 8U, 1000U}) {
        SCOPED_TRACE(testing::Message() << size_px.width << "x" << size_px.height << ", form "
                                        << int(form) << ", " << rows_per_piece << " rows a piece");
        EXPECT_EQ(sweep(job, {.color = form, .mask = true}, rows_per_piece), coverage);
        EXPECT_TRUE(atlas_.ycbcr == expected);
        EXPECT_TRUE(atlas_.mask == mask);
        EXPECT_TRUE(atlas_.color.empty());
      }
    }
  }
}

// Views that look along different rows of the source: a row of the atlas is not swept at once.
TEST_F(PlanarSweepTest, isOfferedOnlyWhereViewsShareTheirRows) {
  const TraceJob together = jobOf(quilt({256, 128}));
  TraceJob apart = together;
  apart.tiles[1].direction.y += 0.25F * apart.tiles[1].direction.z;
  const double inv_z_max = source_.measured().stats.inv_z_max;
  EXPECT_EQ(SweepPlan::make(together, inv_z_max)->colorForm(ColorForm::kYcbcr420),
            ColorForm::kYcbcr420);
  EXPECT_EQ(SweepPlan::make(apart, inv_z_max)->colorForm(ColorForm::kYcbcr420), ColorForm::kRgba);
}

}  // namespace
}  // namespace viewloom::test::planar_sweep_test
