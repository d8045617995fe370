// SPDX-License-Identifier: Apache-2.0
// Rows of a source's colour, each sample the mean along y over what a px of the views covers
// (shaders/color.md, Means).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "frame/color_reach.h"
#include "sweep/aligned_array.h"
#include "sweep/average_kernels.h"
#include "sweep/row_source.h"

namespace viewloom {

// A row between two rows of samples.
struct RowBetween {
  int y = 0;
  bool is_below = false;  // the other row
  float share = 0;        // of the other row, 0..0.5
};

// Links between the columns of a row, by layer, made by findSlopesX and linkColumns.
struct RowColumns {
  ByLayer<const float*> slope_x{};
  ByLayer<const uint8_t*> to_right{};
  ByLayer<const uint8_t*> to_left{};
};

// Keeps what links rows and columns: who asks for rows in order has them linked once.
// Thread-safety: none; one a thread.
class AveragedColor {
 public:
  // For rows of this source, as it is now.
  void begin(const RowSource& source, float reach_px);

  bool isNeeded() const { return reach_px_ > 0; }
  // Blends means around the samples of two rows into packed codes of all layers.
  void blend(const RowBetween& between, const ByLayer<uint32_t*>& texels);
  // Slopes of a row's facets, valid until rows further away are asked for.
  ByLayer<const float*> slopesAlongY(int y) { return facetsAlongY(y).slope; }
  RowColumns columnsOf(int y);

 private:
  struct Layer {
    void reserve(uint32_t width);

    AlignedArray<uint32_t> copy;  // of its colour, if need be
    AlignedArray<float> slope_x;
    AlignedArray<float> slope_y;
    std::array<AlignedArray<uint8_t>, 4> links;  // abi::kEdge...
    AlignedArray<uint8_t> is_mixed;
  };
  static constexpr int kNoRow = -2;
  // Cached values of one row of the source, and the row's number.
  struct Row {
    int slopes_of = kNoRow;
    int columns_linked_of = kNoRow;
    int linked_above_of = kNoRow;
    int linked_below_of = kNoRow;
    int mixed_of = kNoRow;
    ByLayer<Layer> layers;
  };

  // From -1 on.
  Row& rowAt(int y) { return rows_[size_t(y + 1) % rows_.size()]; }
  bool isInside(int y) const { return y >= 0 && y < height_; }
  void findSlopes(int y);
  FacetRow facetsAlongY(int y);
  void linkToRowBelow(int y);
  void markMixedOf(int y);
  void findTaps(const RowBetween& between, size_t side);

  RowSource source_;
  float reach_px_ = 0;
  int height_ = 0;
  uint32_t width_ = 0;
  uint32_t layer_count_ = 0;
  std::vector<Row> rows_;
  std::array<std::vector<AverageTap>, 2> taps_;
};

}  // namespace viewloom
