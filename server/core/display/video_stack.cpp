// SPDX-License-Identifier: Apache-2.0
#include "display/video_stack.h"

#include <algorithm>

#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr uint32_t kCellSideMin_px = 16;  // no encoder takes smaller pictures
constexpr uint64_t kPictureAim_px = 3 << 19;
// Pictures of a stack, where there are views enough: fewer predict worse.
constexpr uint32_t kPictureCountMin = 12;

uint32_t ceilDivide(uint32_t value, uint32_t by) {
  return (value + by - 1) / by;
}

uint32_t evenSide(uint32_t side_px) {
  return std::max(side_px + side_px % 2, kCellSideMin_px);
}

// Columns of a picture with so many cells: as few empty cells as can be, then the squarest.
uint32_t columnsFor(uint32_t cell_count, SizePx cell_px) {
  const uint32_t columns_max = std::min(kVideoPictureMax_px.width / cell_px.width, cell_count);
  const uint32_t rows_max = kVideoPictureMax_px.height / cell_px.height;
  uint32_t best = 0;
  uint64_t best_empty = 0;
  uint64_t best_side_px = 0;
  for (uint32_t columns = 1; columns <= columns_max; ++columns) {
    const uint32_t rows = ceilDivide(cell_count, columns);
    if (rows > rows_max) continue;
    const uint64_t empty = uint64_t{columns} * rows - cell_count;
    const uint64_t side_px =
        std::max(uint64_t{columns} * cell_px.width, uint64_t{rows} * cell_px.height);
    if (best != 0 && (empty > best_empty || (empty == best_empty && side_px >= best_side_px))) {
      continue;
    }
    best = columns;
    best_empty = empty;
    best_side_px = side_px;
  }
  return best;
}

// Cells of a picture at most.
uint32_t cellCountMax(SizePx cell_px) {
  const uint32_t fitting =
      kVideoPictureMax_px.width / cell_px.width * (kVideoPictureMax_px.height / cell_px.height);
  const auto aimed = uint32_t(std::max<uint64_t>(kPictureAim_px / cell_px.area(), 1));
  return std::min(fitting, aimed);
}

}  // namespace

StackCell VideoStack::cellOf(uint32_t view) const {
  const uint32_t cell = view / picture_count;
  return {.picture = view % picture_count, .column = cell % columns, .row = cell / columns};
}

uint32_t VideoStack::viewAt(const StackCell& cell) const {
  const uint64_t rank = uint64_t{cell.row} * columns + cell.column;
  return uint32_t(std::min<uint64_t>(cell.picture + picture_count * rank, view_count));
}

// Counts of pictures from the least one to twice as many are tried. The one with the fewest empty
// cells is taken.
absl::StatusOr<VideoStack> planVideoStack(SizePx view_px, uint32_t view_count) {
  VideoStack stack{.view_count = view_count,
                   .cell_px = {evenSide(view_px.width), evenSide(view_px.height)}};
  if (stack.cell_px.width > kVideoPictureMax_px.width ||
      stack.cell_px.height > kVideoPictureMax_px.height) {
    return absl::ResourceExhaustedError(
        strCat("a view has ", view_px.width, "x", view_px.height,
               " px; accepted for video are views of up to ", kVideoPictureMax_px.width, "x",
               kVideoPictureMax_px.height, " px. Choose smaller views, or color as JPEG"));
  }
  const uint32_t cell_max = cellCountMax(stack.cell_px);
  const uint32_t least =
      std::max(ceilDivide(view_count, cell_max), std::min(kPictureCountMin, view_count));
  uint64_t best_empty = UINT64_MAX;
  for (uint32_t count = least; count <= std::min(2 * least, view_count); ++count) {
    const uint32_t cell_count = ceilDivide(view_count, count);
    const uint32_t columns = columnsFor(cell_count, stack.cell_px);
    if (columns == 0) continue;
    const uint32_t rows = ceilDivide(cell_count, columns);
    const uint64_t empty = uint64_t{count} * columns * rows - view_count;
    if (empty >= best_empty) continue;
    best_empty = empty;
    stack.picture_count = count;
    stack.columns = columns;
    stack.rows = rows;
  }
  return stack;
}

// Measured on OpenH264 2.3.1, from 320x240 to 4096x2176 px.
uint64_t videoEncoderBytes(SizePx picture_px) {
  constexpr uint64_t kAlways_bytes = uint64_t{3} << 20;
  constexpr uint64_t kPixel_bytes = 10;
  return kAlways_bytes + kPixel_bytes * picture_px.area();
}

uint64_t videoPicturesBytes(const VideoStack& stack) {
  return stack.pictureSize().area() * stack.picture_count * 3 / 2;
}

uint64_t videoAtlasBytes(const VideoStack& stack) {
  return videoEncoderBytes(stack.pictureSize()) + videoPicturesBytes(stack);
}

}  // namespace viewloom
