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

// The frame, numbered `number` and seen from a place of that number: no two of them are alike.
FramePtr movedFrame(const Frame& frame, uint64_t number);

// Such layers, of any scene; 0 = a connection tolerance by the content.
FramePtr layeredFrame(uint64_t number, const Camera& camera, SizePx size_px,
                      std::vector<SyntheticLayer> layers, double connection_tolerance = 0);

// Frames of one layer, seen from so many places along x, m: a source each.
FramePtr syntheticFrameFrom(uint64_t number, const std::vector<double>& places_m,
                            SizePx size_px = {160, 90});

// Frame of two layers, as a cube map in the place that the scene is meant to be seen from.
FramePtr syntheticCubeFrame(uint64_t number, uint32_t side_px = 48);

// A small quilt of 4x2 views, complete.
DisplaySpec smallQuilt(SizePx size_px = {320, 200});

// A camera that stands in the source's place, turned: no row of it lies in a row of the source, so
// it needs the walk.
DisplaySpec turnedCamera();

}  // namespace viewloom::test
