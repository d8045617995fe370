// SPDX-License-Identifier: Apache-2.0
// The view through a lens that is scored, and its true picture.
#pragma once

#include <cstdint>
#include <vector>

#include "frame/camera.h"
#include "support/truth/scenes.h"

namespace viewloom::bench {

inline constexpr double kLensFocus_m = 2.4;

// From the source's own place, or to the right of that.
Camera lensCamera(uint32_t width_px, double aside_m = 0);
SizePx lensPictureSize(uint32_t width_px);

// Linear light, float[height][width][3]: the mean of so many exact rays a px, over its area and the
// lens.
std::vector<float> trueLensPicture(const truth::Instant& instant, const Camera& camera,
                                   SizePx size_px, double radius_m, uint32_t ray_count);

// float[height][width]: the share of such rays that see what only deeper layers of the source hold.
std::vector<float> hiddenShares(const truth::Instant& instant, const Camera& camera, SizePx size_px,
                                double radius_m, uint32_t ray_count);

}  // namespace viewloom::bench
