// SPDX-License-Identifier: Apache-2.0
#include "patterns/finish_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace viewloom::patterns {
namespace {

// Light-field panels are looked at from where they are some 15 degrees high.
constexpr double kFovY_rad = 18 * std::numbers::pi / 180;
// Far below the least step between two surfaces of a pattern, far above the rounding of depth.
constexpr double kConnectionTolerance_inv_m = 1e-3;

}  // namespace

double unitPx(SizePx size_px) {
  return std::min(size_px.width / 1920.0, size_px.height / 1080.0);
}

PxBox wholeImage(SizePx size_px) {
  return {.left = 0,
          .top = 0,
          .right = static_cast<double>(size_px.width),
          .bottom = static_cast<double>(size_px.height)};
}

double defaultFocalPx(SizePx size_px) {
  return 0.5 * size_px.height / std::tan(kFovY_rad / 2);
}

absl::StatusOr<Pattern> finishPattern(SizePx size_px, double focal_px,
                                      std::initializer_list<LayerDrawing*> layers,
                                      const Lettering& lettering) {
  if (!lettering.status().ok()) return lettering.status();
  Pattern pattern{.camera = {},
                  .size_px = size_px,
                  .layers = {},
                  .connection_tolerance = kConnectionTolerance_inv_m};
  pattern.camera.intrinsics = {.focal_px = glm::dvec2(focal_px),
                               .principal_px = {size_px.width / 2.0, size_px.height / 2.0}};
  for (LayerDrawing* layer : layers) pattern.layers.push_back(layer->take());
  return pattern;
}

}  // namespace viewloom::patterns
