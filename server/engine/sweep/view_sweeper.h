// SPDX-License-Identifier: Apache-2.0
// Sweeps atlases: the answers of the walk, for views beside the source in its rows.
#pragma once

#include <span>
#include <vector>

#include "base/worker_pool.h"
#include "picture/trace_job.h"
#include "sweep/light_sums.h"
#include "sweep/surface_row_builder.h"
#include "sweep/sweep_plan.h"
#include "sweep/swept_atlas.h"
#include "sweep/ycbcr_rows.h"

namespace viewloom {

// A display that is swept over a source.
struct SweepPicture {
  const TraceJob* job = nullptr;
  const SweepPlan* plan = nullptr;
  RowSource source;
  float inv_z_max = 0;  // of the source, 1/m
};

// Keeps what a row needs on its way. Thread-safety: none; one a thread. Several may sweep rows of
// one atlas.
class ViewSweeper {
 public:
  // Rows of the plan: all that views see along them. The plan can colour in the form of `outputs`;
  // but for kRgba, rows are those of all tiles, and some may move to a neighbouring piece.
  Coverage sweepRows(const SweepPicture& picture, uint32_t first_row, uint32_t row_count,
                     const TraceOutputs& outputs, SweptAtlas& atlas) {
    return sweepRows(picture, first_row, row_count, {0, picture.job->layout->rows}, outputs, atlas);
  }
  // The same of some rows of tiles alone, where canShareTiles().
  Coverage sweepRows(const SweepPicture& picture, uint32_t first_row, uint32_t row_count,
                     GridRows grid, const TraceOutputs& outputs, SweptAtlas& atlas);
  // Whether rows of the plan can be swept by rows of tiles.
  static bool canShareTiles(const SweepPlan& plan, const AtlasLayout& layout, ColorForm form) {
    return plan.lensPieces() == nullptr && keepsPairsInTiles(layout, form);
  }

 private:
  struct Piece;

  void colorLenses(const Piece& piece, const SurfaceRow& row, std::span<const LensPiece> lenses,
                   uint32_t channel_mask, uint32_t* panel_row);
  void sweepLenses(Piece& piece, uint32_t index);
  template <typename Takes, typename RowOf>
  void sweepRow(Piece& piece, uint32_t index, const Takes& takes, const RowOf& rowOf);
  template <typename Takes, typename RowOf>
  void sweepSample(Piece& piece, uint32_t index, uint32_t sample, const Takes& takes,
                   const RowOf& rowOf);

  SurfaceRowBuilder builder_;
  SweptRow row_;
  YcbcrRows ycbcr_rows_;
  LightSums sums_;  // of px with several samples
  std::vector<uint32_t> sampled_;
  std::vector<LensPiece> lens_pieces_;
  std::vector<int32_t> lens_texels_;  // of pieces that are not coloured yet, px by px
};

// The whole atlas by all workers; `sweepers`: one each, kept from atlas to atlas.
Coverage sweepAtlas(const SweepPicture& picture, const TraceOutputs& outputs, WorkerPool& workers,
                    std::vector<ViewSweeper>& sweepers, SweptAtlas& atlas);

}  // namespace viewloom
