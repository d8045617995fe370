// SPDX-License-Identifier: Apache-2.0
// Which view each subpixel of a panel behind slanted lenses shows. With u = (x + 1/2) / W,
// v = (y + 1/2) / H from the bottom, P lenses across the panel and their tilt T, a channel at the
// offset (a, b) from the centre of its px lies at
//   z = fract(((u + a) + (v + b) T) P - center)
// of its lens's width, and shows the view at z, or at 1 - z where the order of views is inverted.
// The sum is linear in x and y, so it is split into a share of the column, one of the row and a
// constant, each reduced to a fraction of a lens beforehand.
#ifndef VIEWLOOM_SHADERS_SHARED_LENTICULAR_H_
#define VIEWLOOM_SHADERS_SHARED_LENTICULAR_H_

#include "shared/gpu_types.h"

VIEWLOOM_ABI_BEGIN

// How the cells of a panel repeat; the numbers of CellPatternMode in calibration files. x counts
// from the left, y from the bottom.
VIEWLOOM_ABI_CONST uint kCellsAlike = 0u;       // all px are cell 0
VIEWLOOM_ABI_CONST uint kCellsChequered = 1u;   // (x + y) % 2
VIEWLOOM_ABI_CONST uint kCellsByColumn = 2u;    // x % 2
VIEWLOOM_ABI_CONST uint kCellsByFourRows = 3u;  // (y + 2 * (x % 2)) % 4
VIEWLOOM_ABI_CONST uint kCellsByRow = 4u;       // y % 2
VIEWLOOM_ABI_CONST uint kCellCountMax = 4u;
VIEWLOOM_ABI_CONST uint kCellChannels = 3u;  // red, green, blue

// Phases are fractions of a lens in units of 2^-32: whole numbers wrap around as fract() does, sums
// and products of them are exact, and every device gives the same bits. 16384 px add up to an error
// of 2e-6 of a lens.
struct Lenticular {
  uint height_px;         // of the panel
  uint phase_per_column;  // from one px to the next to the right
  uint phase_per_row;     // from one px to the next upwards
  uint cell_mode;         // kCells...
  uint cell_count;        // 1..kCellCountMax
  uint is_inverted;  // 1: view 0 is seen at the right end of a lens, as all known devices have it
  uint cell_phase[12];  // [cell][channel], in the bottom left px; 0 where there is no such cell
};

VIEWLOOM_ABI_FUNCTION uint lensCell(Lenticular lens, uint x_px, uint y_from_bottom_px) {
  uint cell = 0u;
  if (lens.cell_mode == kCellsChequered) cell = (x_px + y_from_bottom_px) % 2u;
  if (lens.cell_mode == kCellsByColumn) cell = x_px % 2u;
  if (lens.cell_mode == kCellsByFourRows) cell = (y_from_bottom_px + 2u * (x_px % 2u)) % 4u;
  if (lens.cell_mode == kCellsByRow) cell = y_from_bottom_px % 2u;
  return cell % lens.cell_count;
}

// Where among the views a subpixel shows: 0 = the first (leftmost) view's outer end, towards 1 =
// the last one's; [0, 1), a multiple of 2^-24. y_from_top_px < height_px; channel: 0 red, 1 green,
// 2 blue.
VIEWLOOM_ABI_FUNCTION float viewCoordinate(Lenticular lens, uint x_px, uint y_from_top_px,
                                           uint channel) {
  uint y_px = lens.height_px - 1u - y_from_top_px;
  uint cell = lensCell(lens, x_px, y_px);
  uint phase = x_px * lens.phase_per_column + y_px * lens.phase_per_row +
               lens.cell_phase[kCellChannels * cell + channel];
  if (lens.is_inverted != 0u) phase = ~phase;  // 1 - z, less 2^-32: 1 itself is no view
  return float(phase >> 8u) * 5.9604644775390625e-8f;
}

// The view that holds the coordinate when view_count views share it evenly.
VIEWLOOM_ABI_FUNCTION uint nearestView(float coordinate, uint view_count) {
  uint view = uint(coordinate * float(view_count));
  return view < view_count ? view : view_count - 1u;  // the product may have been rounded up
}

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_LENTICULAR_H_
