// SPDX-License-Identifier: Apache-2.0
// Rows of an atlas between the tiles that colour them and the planes that JPEG takes.
#pragma once

#include <algorithm>
#include <cstdint>

#include "display/atlas_layout.h"
#include "display/color_form.h"
#include "sweep/aligned_array.h"

namespace viewloom {

// Rows [first, end) of the grid of tiles.
struct GridRows {
  uint32_t first = 0;
  uint32_t end = 0;
};

// Whether no pair of rows of chroma crosses from one row of tiles to the next.
inline bool keepsPairsInTiles(const AtlasLayout& layout, ColorForm form) {
  return form != ColorForm::kYcbcr420 ||
         (layout.padding_top_px % 2 == 0 && layout.tile_size_px.height % 2 == 0);
}

// Chroma of 4:2:0 takes two rows of the atlas, and where tiles have an odd height or place, such a
// pair begins on an odd row of a tile, or crosses from tile to tile. So a piece of a sweep takes
// the pairs that belong to its rows, and its last piece those that cross. Rows stay in the cache
// between being coloured and converted.
// Thread-safety: none; one a thread.
class YcbcrRows {
 public:
  // A row of all tiles that stand in one row of the atlas.
  struct Step {
    uint32_t tile_row = 0;
    bool is_crossing = false;  // of those alone whose other half is the last row of the tiles above
  };

  // The piece's rows of tiles; the atlas is black where nothing will be coloured. `form`: not
  // kRgba. The layout must stay. Only tiles in these rows of the grid are taken: all of them, or
  // no pairs of rows cross.
  void begin(const AtlasLayout& layout, ColorForm form, uint32_t first_row, uint32_t row_count,
             GridRows grid);

  // Calls sweep(step) for every row of which some tile is to be coloured, then converts what is
  // complete into `planes`.
  template <typename Sweep>
  void forEachStep(uint8_t* planes, const Sweep& sweep) {
    const uint32_t height_px = layout_->tile_size_px.height;
    const uint32_t first = first_row_ - std::min(first_row_, 1U);
    for (uint32_t row = first; row < std::min(end_row_ + 1, height_px); ++row) {
      runStep({.tile_row = row}, planes, sweep);
    }
    if (end_row_ == height_px) runStep({.is_crossing = true}, planes, sweep);
  }

  bool takes(uint32_t tile, Step step) const { return takesRow(tile / layout_->columns, step); }
  // Where the row of this tile (row-major from the top left) is coloured: R, G, B, ignored.
  uint32_t* rowOf(uint32_t tile, Step step);

 private:
  template <typename Sweep>
  void runStep(Step step, uint8_t* planes, const Sweep& sweep) {
    bool takes_any = false;
    for (uint32_t i = 0; i < layout_->rows; ++i) takes_any |= takesRow(i, step);
    if (!takes_any) return;
    sweep(step);
    for (uint32_t i = 0; i < layout_->rows; ++i) {
      if (takesRow(i, step)) convert(i, step, planes);
    }
  }

  // Whether tiles in this row of the grid take it.
  bool takesRow(uint32_t grid_row, Step step) const;
  uint32_t atlasRow(uint32_t grid_row, Step step) const {
    return layout_->padding_top_px + grid_row * layout_->tile_size_px.height + step.tile_row;
  }
  uint32_t* bufferOf(uint32_t grid_row, Step step);
  void convert(uint32_t grid_row, Step step, uint8_t* planes);

  const AtlasLayout* layout_ = nullptr;
  ColorForm form_ = ColorForm::kYcbcr420;
  uint32_t first_row_ = 0;
  uint32_t end_row_ = 0;
  GridRows grid_;
  uint32_t stride_px_ = 0;
  AlignedArray<uint32_t> rows_;  // [row of the grid + 1, of a pair's upper half][half][stride_px_]
};

}  // namespace viewloom
