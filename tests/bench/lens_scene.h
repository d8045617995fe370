// SPDX-License-Identifier: Apache-2.0
// The view through a lens that is scored, and its true picture.
#pragma once

#include <cstdint>
#include <vector>

#include "frame/camera.h"
#include "support/truth/scenes.h"

namespace viewloom::bench {

inline constexpr double kLensRadius_m = 0.02;
inline constexpr double kLensFocus_m = 2.4;

// From the source's own place.
Camera lensCamera(uint32_t width_px);
SizePx lensPictureSize(uint32_t width_px);

// Linear light, float[height][width][3]: the mean of so many exact rays a px, over its area and the
// lens.
std::vector<float> trueLensPicture(const truth::Instant& instant, uint32_t width_px,
                                   uint32_t ray_count);

}  // namespace viewloom::bench
