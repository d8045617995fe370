// SPDX-License-Identifier: Apache-2.0
// Atlases swept as Y'CbCr are judged by the same atlas in RGB and libjpeg-turbo's conversion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

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

  // In pieces of so many rows, and where that can be so many rows of the grid, from the last to the
  // first, into memory of an older atlas.
  Coverage sweep(const TraceJob& job, const TraceOutputs& outputs, uint32_t rows_per_piece,
                 uint32_t grid_rows_per_piece = 1000) {
    const double inv_z_max = source_.measured().stats.inv_z_max;
    const SweepPlan plan = SweepPlan::make(job, inv_z_max).value();
    atlas_.begin(job, outputs);
    Coverage coverage;
    for (uint32_t piece = (plan.rowCount() + rows_per_piece - 1) / rows_per_piece; piece-- > 0;) {
      const uint32_t first = piece * rows_per_piece;
      const SweepPicture picture{
          .job = &job, .plan = &plan, .source = source_.rowSource(), .inv_z_max = float(inv_z_max)};
      const uint32_t grid_rows = job.layout->rows;
      const uint32_t step = ViewSweeper::canShareTiles(plan, *job.layout, outputs.color)
                                ? std::min(grid_rows_per_piece, grid_rows)
                                : grid_rows;
      for (uint32_t row = 0; row < grid_rows; row += step) {
        coverage.add(sweeper_.sweepRows(picture, first,
                                        std::min(rows_per_piece, plan.rowCount() - first),
                                        {row, std::min(row + step, grid_rows)}, outputs, atlas_));
        ++piece_count_;
      }
    }
    return coverage;
  }

  void fillPlanes(uint8_t byte) {
    const auto fill = [&](auto& plane) {
      std::memset(static_cast<void*>(plane.data()), byte, plane.size() * sizeof plane[0]);
    };
    fill(atlas_.color);
    fill(atlas_.depth);
    fill(atlas_.mask);
    fill(atlas_.linear);
    fill(atlas_.records);
  }

  static std::vector<size_t> unusedPxOf(const AtlasLayout& layout) {
    std::vector<size_t> unused;
    for (size_t px = 0; px < layout.size_px.area(); ++px) {
      const size_t column = px % layout.size_px.width / layout.tile_size_px.width;
      const size_t y = px / layout.size_px.width;
      const bool is_above = y < layout.padding_top_px;
      const size_t row = is_above ? 0 : (y - layout.padding_top_px) / layout.tile_size_px.height;
      if (is_above || column >= layout.columns ||
          layout.viewAt(uint32_t(column), uint32_t(row)) == layout.views.size()) {
        unused.push_back(px);
      }
    }
    return unused;
  }

  WorkerPool workers_{2};
  SweepSource source_;
  ViewSweeper sweeper_;
  SweptAtlas atlas_;
  SweptAtlas first_;  // the same picture, swept before
  size_t piece_count_ = 0;
};

TEST_F(PlanarSweepTest, givesThePlanesOfTheWholeAtlasHoweverRowsAreShared) {
  for (const SizePx size_px : kAtlases_px) {
    const TraceJob job = jobOf(quilt(size_px));
    ASSERT_EQ(job.layout->size_px, size_px);
    const Coverage coverage = sweep(job, kRgb, 8);
    const UntouchedVector<uint32_t> rgb = atlas_.color;
    const UntouchedVector<uint8_t> mask = atlas_.mask;
    for (const ColorForm form : {ColorForm::kYcbcr420, ColorForm::kYcbcr444}) {
      const std::vector<uint8_t> expected = ycbcrPlanesOf(rgb, size_px, form);
      for (const uint32_t rows_per_piece : {1U, 2U, 3U, 8U, 1000U}) {
        SCOPED_TRACE(testing::Message() << size_px.width << "x" << size_px.height << ", form "
                                        << int(form) << ", " << rows_per_piece << " rows a piece");
        const TraceOutputs outputs = {.color = form, .mask = true};
        atlas_.begin(job, outputs);
        std::ranges::fill(atlas_.ycbcr, uint8_t{0xa5});
        EXPECT_EQ(sweep(job, outputs, rows_per_piece), coverage);
        EXPECT_TRUE(std::ranges::equal(atlas_.ycbcr, expected));
        EXPECT_TRUE(atlas_.mask == mask);
        EXPECT_TRUE(atlas_.color.empty());
      }
    }
  }
}

// Rows of tiles of one row of the plan, each swept apart.
TEST_F(PlanarSweepTest, givesTheSameAtlasWhereTilesAreShared) {
  for (const SizePx size_px : kAtlases_px) {
    const TraceJob job = jobOf(quilt(size_px));
    for (const ColorForm form : {ColorForm::kRgba, ColorForm::kYcbcr420, ColorForm::kYcbcr444}) {
      SCOPED_TRACE(testing::Message()
                   << size_px.width << "x" << size_px.height << ", form " << int(form));
      const TraceOutputs outputs{.color = form, .depth = true, .mask = true};
      piece_count_ = 0;
      const Coverage coverage = sweep(job, outputs, 2);
      const size_t whole_count = piece_count_;
      const SweptAtlas whole = atlas_;
      atlas_.begin(job, outputs);
      fillPlanes(0xa5);
      std::ranges::fill(atlas_.ycbcr, uint8_t{0xa5});
      EXPECT_EQ(sweep(job, outputs, 2, 1), coverage);
      const size_t grid_rows = keepsPairsInTiles(*job.layout, form) ? job.layout->rows : 1;
      EXPECT_EQ(piece_count_, whole_count * (1 + grid_rows));
      EXPECT_TRUE(atlas_.color == whole.color);
      EXPECT_TRUE(atlas_.ycbcr == whole.ycbcr);
      EXPECT_TRUE(atlas_.depth == whole.depth);
      EXPECT_TRUE(atlas_.mask == whole.mask);
    }
  }
}

// Whatever lay in memory, no px shows it: px beside views and where none stands are black.
TEST_F(PlanarSweepTest, showsNothingOfWhatMemoryHeldBefore) {
  constexpr TraceOutputs kAll{.depth = true, .mask = true, .linear = true, .records = true};
  for (const SizePx size_px : kAtlases_px) {
    SCOPED_TRACE(testing::Message() << size_px.width << "x" << size_px.height);
    const TraceJob job = jobOf(quilt(size_px));
    const auto unused = unusedPxOf(*job.layout);
    for (const uint32_t rows_per_piece : {1U, 3U, 1000U}) {
      for (const uint8_t byte : {uint8_t{0}, uint8_t{0xa5}}) {
        atlas_.begin(job, kAll);
        fillPlanes(byte);
        sweep(job, kAll, rows_per_piece);
        for (const size_t px : unused) {
          ASSERT_EQ(atlas_.color[px], kOpaqueBlack) << px;
          ASSERT_EQ(atlas_.depth[px], 0) << px;
          ASSERT_EQ(atlas_.mask[px], 0) << px;
          for (size_t c = 0; c < 4; ++c) ASSERT_EQ(atlas_.linear[4 * px + c], 0) << px;
          ASSERT_EQ(atlas_.records[px].inv_z, 0) << px;
        }
        if (byte == 0) first_ = atlas_;
        EXPECT_TRUE(atlas_.color == first_.color);
        EXPECT_TRUE(atlas_.depth == first_.depth);
        EXPECT_TRUE(atlas_.mask == first_.mask);
        EXPECT_TRUE(atlas_.linear == first_.linear);
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
