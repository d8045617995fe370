// SPDX-License-Identifier: Apache-2.0
// What a frame tells of motion.
#pragma once

#include "frame/frame.h"
#include "temporal/camera_track.h"

namespace viewloom {

// As if it had been there, and built, when it was captured. `before`: the frame before it; nullptr:
// there is none. `inv_z_near`: 1/m, of its nearest surfaces.
TrackedFrame trackedFrame(const Frame& frame, const Frame* before, double inv_z_near);

}  // namespace viewloom
