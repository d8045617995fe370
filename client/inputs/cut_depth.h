// SPDX-License-Identifier: Apache-2.0
// Depth without what lies beyond a distance.
#pragma once

#include "base/status.h"
#include "lib/wire_frame.h"

namespace viewloom::inputs {

// Samples of all layers of the frame's only source that are farther than `farthest_m`, or
// infinitely far, become no surface. Their planes get a number that says so; planes of whole
// numbers without one become floats.
absl::Status cutDepth(double farthest_m, v1::Source& source, WireFrame& wire);

}  // namespace viewloom::inputs
