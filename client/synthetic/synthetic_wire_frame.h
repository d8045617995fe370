// SPDX-License-Identifier: Apache-2.0
// The synthetic scene as a frame ready to be published.
#pragma once

#include <vector>

#include "lib/wire_frame.h"
#include "synthetic/synthetic_frame.h"

namespace viewloom {

// RGBA8 sRGB colour and binary32 planar depth in every layer. The number is left to the publisher.
WireFrame syntheticWireFrame(const SyntheticOptions& options, int64_t capture_time_ns);
// Adds the scene as one more source of the frame.
void addSyntheticSource(const SyntheticOptions& options, WireFrame& frame);
// Layers of one size, nearest first, seen by this camera, as one more source; returns it.
v1::Source& addLayeredSource(const Camera& camera, SizePx size_px,
                             std::vector<SyntheticLayer> layers, WireFrame& frame);
// The scene as a cube map, with faces as high as size_px. Of the camera, the pose alone counts;
// without one it stands where the scene is meant to be seen from.
void addSyntheticCubeMap(const SyntheticOptions& options, WireFrame& frame);

}  // namespace viewloom
