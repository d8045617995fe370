// SPDX-License-Identifier: Apache-2.0
// The frames of the benchmark's loads: opaque 8-bit colour and binary32 1/Z, any number of layers.
#pragma once

#include <cstdint>

#include "frame/frame.h"

namespace viewloom::bench {

// The built-in scene: balls, poles, a panel, ground and ridges; edges everywhere.
FramePtr clutterFrame(SizePx size_px, uint32_t layer_count);
// Ground, a wall and gentle hills, striped: few edges, large planes. Deeper layers are walls
// further back.
FramePtr smoothFrame(SizePx size_px, uint32_t layer_count);
// Wires one to three px wide, at any depth, before a wall. Deeper layers are the wall behind the
// wires, then nothing.
FramePtr thinFrame(SizePx size_px, uint32_t layer_count);

// Gaussian noise on 1/Z, 1/m; the same seed gives the same bytes.
FramePtr withNoise(const Frame& frame, double sigma_inv_z, uint32_t seed);

}  // namespace viewloom::bench
