// SPDX-License-Identifier: Apache-2.0
// Stereo pairs: two off-axis eyes on a line, or two given cameras.
#pragma once

#include <vector>

#include "display/atlas_layout.h"

namespace viewloom {

// Expects a completed spec. Left, right; without given cameras at -/+ half the eye distance, both
// framing one rectangle on the focal plane.
std::vector<View> stereoViews(const StereoSpec& stereo, const StreamDefaults& defaults);

}  // namespace viewloom
