// SPDX-License-Identifier: Apache-2.0
// Decoded frames of the synthetic scene, as the pipeline takes them.
#pragma once

#include <vector>

#include "display/display_spec.h"
#include "frame/frame.h"
#include "synthetic/synthetic_frame.h"

namespace viewloom::test {

// Layers of the synthetic scene at time_s, numbered `number`.
FramePtr syntheticFrame(uint64_t number, SizePx size_px = {160, 90}, uint32_t layer_count = 2,
                        double time_s = 0);

// Such layers, of any scene; 0 = a connection tolerance by the content.
FramePtr layeredFrame(uint64_t number, const Camera& camera, SizePx size_px,
                      std::vector<SyntheticLayer> layers, double connection_tolerance = 0);

// Of one layer, seen from so many places along x, m: a source each.
FramePtr syntheticFrameFrom(uint64_t number, const std::vector<double>& places_m,
                            SizePx size_px = {160, 90});

// Of two layers, as a cube map in the place that the scene is meant to be seen from.
FramePtr syntheticCubeFrame(uint64_t number, uint32_t side_px = 48);

// A small quilt of 4x2 views, complete.
DisplaySpec smallQuilt(SizePx size_px = {320, 200});

}  // namespace viewloom::test
