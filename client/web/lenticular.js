// SPDX-License-Identifier: Apache-2.0
// The lenses of a calibrated panel as the shader takes them: struct Lenticular of lenticular.h.
import {lensCount} from './calibration.js';

const kLens = 2 ** 32;
const kCellCountMax = 4;
const kChannelCount = 3;

// How many widths of the panel a lens moves to the left from its bottom to its top.
function lensTilt({slope, flip_x, screen_px}) {
  const tilt = screen_px.height / (screen_px.width * slope);
  return flip_x ? -tilt : tilt;
}

function offsetOf({flip_subpixels, flip_x, cells}, cell, channel) {
  const at = flip_subpixels ? kChannelCount - 1 - channel : channel;
  return cells.length ? cells[cell][at] : {x_px: (flip_x ? -1 : 1) * at / kChannelCount, y_px: 0};
}

// A fraction that rounds to a whole lens wraps to 0, as it has to.
function phaseOf(lenses) {
  return Math.round((lenses - Math.floor(lenses)) * kLens) % kLens;
}

export function makeLenticular(calibration) {
  const {screen_px, cells} = calibration;
  const lenses = lensCount(calibration);
  const per_column = lenses / screen_px.width;
  const per_row = lensTilt(calibration) * lenses / screen_px.height;
  const cell_count = Math.max(1, cells.length);
  const cell_phase = new Uint32Array(kCellCountMax * kChannelCount);
  for (let cell = 0; cell < cell_count; ++cell) {
    for (let channel = 0; channel < kChannelCount; ++channel) {
      const {x_px, y_px} = offsetOf(calibration, cell, channel);
      cell_phase[kChannelCount * cell + channel] = phaseOf(
          (0.5 + x_px) * per_column + (0.5 + y_px) * per_row - calibration.center);
    }
  }
  return {
    height_px: screen_px.height,
    phase_per_column: phaseOf(per_column),
    phase_per_row: phaseOf(per_row),
    cell_mode: calibration.cell_pattern_mode,
    cell_count,
    is_inverted: calibration.inv_view ? 1 : 0,
    cell_phase,
  };
}
