// SPDX-License-Identifier: Apache-2.0
#include "inputs/sensor_presets.h"

#include "files/depth_packing.h"

namespace viewloom::inputs {
namespace {

// Metres of the code 1; 0 for kinds that are no sensor.
double unitOf(InputKind kind) {
  switch (kind) {
    case InputKind::kSensor:
    case InputKind::kRecord3d:
      return 0.001;
    case InputKind::kKitti:
      return 1.0 / 256;
    case InputKind::kTum:
      return 1.0 / 5000;
    case InputKind::kL515:
      return 0.00025;
    case InputKind::kD405:
      return 0.0001;
    default:
      return 0;
  }
}

}  // namespace

bool isSensor(InputKind kind) {
  return unitOf(kind) != 0;
}

v1::DepthFormat sensorFormat(const InputSettings& settings, InputKind kind) {
  v1::DepthFormat format;
  const bool is_disparity = kind == InputKind::kKitti && settings.baseline_m;
  format.set_meaning(is_disparity ? v1::DEPTH_MEANING_DISPARITY : v1::DEPTH_MEANING_PLANAR);
  // Digits of a packed depth count as the whole number that they make.
  format.set_scale(unitOf(kind) * files::codeMaxOf(settings.depth_packing));
  format.set_invalid_value(0);
  return format;
}

void settleRecord3d(const InputSettings& settings, bool is_float, v1::DepthFormat& format) {
  if (is_float && !settings.depth_scale) format.set_scale(1);
}

void settleBaseline(double focal_px, double baseline_m, v1::DepthFormat& format) {
  const double scale = format.scale() == 0 ? 1 : format.scale();
  format.set_scale(scale / (focal_px * baseline_m));
  format.set_offset(format.offset() / (focal_px * baseline_m));
}

}  // namespace viewloom::inputs
