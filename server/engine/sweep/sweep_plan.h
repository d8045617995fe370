// SPDX-License-Identifier: Apache-2.0
// Which rows of the source the views of a display look along, when it can be swept at all.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "picture/trace_job.h"
#include "sweep/lens_pieces.h"
#include "sweep/paint_kernels.h"

namespace viewloom {

// Views whose rows look along the same rows of the source.
struct SweptTiles {
  double first_px = 0;  // row r of a tile looks along first + step r
  double step_px = 0;
  float tolerance = 0;     // in inv_z, the least of the views', 1/m
  float px_per_inv_z = 0;  // by which rays move, the most of any view
  std::vector<uint32_t> tiles;
};

// Immutable. Thread-safety: all methods may be called from any thread.
class SweepPlan {
 public:
  // Rays of a row of a view stay in a row of the source, and are parallel in (x, inv_z): the eyes
  // lie beside the source along its rows, and look along its axes. So do those of a lenticular
  // panel's subpixels, piece by piece. nullopt for any other display.
  // `inv_z_max`: of the source, 1/m.
  static std::optional<SweepPlan> make(const TraceJob& job, double inv_z_max);

  // The form in which whole rows can be coloured: that one, if all views look along the same rows,
  // else kRgba.
  ColorForm colorForm(ColorForm wanted) const {
    return group_count_ == 1 && !lens_pieces_ ? wanted : ColorForm::kRgba;
  }

  // How far colour is averaged.
  const ColorReach& colorReach() const { return color_reach_; }

  // Tile row r of group g is row g * height + r of the plan; every sample of a px has the same
  // tiles in it.
  uint32_t rowCount() const { return group_count_ * tile_height_; }
  uint32_t sampleCount() const { return uint32_t(groups_.size()); }
  uint32_t tileRow(uint32_t row) const { return row % tile_height_; }
  const SweptTiles& groupOf(uint32_t row, uint32_t sample = 0) const {
    return groups_[sample][row / tile_height_];
  }
  SweepView viewOf(uint32_t tile, uint32_t sample = 0) const {
    const OneEye& view = views_[sample][tile];
    return {.start_px = view.start_px, .step_px = view.step_px, .eye_px_m = view.eye_px_m};
  }
  // Pieces of a lenticular panel, used instead of viewOf(); else null.
  const LensPieces* lensPieces() const { return lens_pieces_ ? &*lens_pieces_ : nullptr; }

 private:
  // The members of SweepView of which there may be thousands.
  struct OneEye {
    float start_px = 0;
    float step_px = 1;
    float eye_px_m = 0;
  };

  static OneEye eyeOf(const abi::ViewParams& tile);
  void addTile(uint32_t index, const abi::ViewParams& tile);

  uint32_t tile_height_ = 1;
  uint32_t group_count_ = 0;
  ColorReach color_reach_;
  std::optional<LensPieces> lens_pieces_;
  std::vector<std::vector<SweptTiles>> groups_;  // [sample][group]
  std::vector<std::vector<OneEye>> views_;       // [sample][tile]
};

}  // namespace viewloom
