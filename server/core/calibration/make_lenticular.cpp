// SPDX-License-Identifier: Apache-2.0
#include "calibration/make_lenticular.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace viewloom {
namespace {

// Index of the file's channel that holds a channel of the picture.
uint32_t channelAt(const Calibration& calibration, uint32_t channel) {
  return calibration.flip_subpixels ? 2 - channel : channel;
}

SubpixelOffset offsetOf(const Calibration& calibration, size_t cell, uint32_t channel) {
  const uint32_t at = channelAt(calibration, channel);
  if (calibration.cells.empty()) return {.x_px = (calibration.flip_x ? -1.0 : 1.0) * at / 3.0};
  const SubpixelCell& subpixels = calibration.cells[cell];
  return at == 0 ? subpixels.red : at == 1 ? subpixels.green : subpixels.blue;
}

uint32_t phaseOf(double lenses) {
  constexpr double kLens = 4294967296.0;
  // A fraction that rounds to a whole lens wraps to 0, as it has to.
  return static_cast<uint32_t>(std::llround((lenses - std::floor(lenses)) * kLens));
}

}  // namespace

double lensCount(const Calibration& calibration) {
  return calibration.pitch * calibration.screen_px.width / calibration.dpi *
         std::cos(std::atan(1 / calibration.slope));
}

double lensTilt(const Calibration& calibration) {
  const double tilt =
      calibration.screen_px.height / (calibration.screen_px.width * calibration.slope);
  return calibration.flip_x ? -tilt : tilt;
}

abi::Lenticular makeLenticular(const Calibration& calibration) {
  VIEWLOOM_CHECK(calibration.cells.size() <= abi::kCellCountMax);
  const double lenses = lensCount(calibration);
  const double per_column = lenses / calibration.screen_px.width;
  const double per_row = lensTilt(calibration) * lenses / calibration.screen_px.height;
  abi::Lenticular lens{
      .height_px = calibration.screen_px.height,
      .phase_per_column = phaseOf(per_column),
      .phase_per_row = phaseOf(per_row),
      .cell_mode = calibration.cell_pattern_mode,
      .cell_count = std::max(1u, static_cast<uint32_t>(calibration.cells.size())),
      .is_inverted = calibration.inv_view ? 1u : 0u,
  };
  for (uint32_t cell = 0; cell < lens.cell_count; ++cell) {
    for (uint32_t channel = 0; channel < abi::kCellChannels; ++channel) {
      const SubpixelOffset offset = offsetOf(calibration, cell, channel);
      lens.cell_phase[abi::kCellChannels * cell + channel] = phaseOf(
          (0.5 + offset.x_px) * per_column + (0.5 + offset.y_px) * per_row - calibration.center);
    }
  }
  return lens;
}

}  // namespace viewloom
