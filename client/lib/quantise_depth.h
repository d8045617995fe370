// SPDX-License-Identifier: Apache-2.0
// Converts binary32 depth to 16-bit inverse depth, where the difference is too small to see.
#pragma once

#include <span>
#include <string>

#include "base/byte_pool.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom {

// Result for the binary32 depth of a source.
struct QuantisedDepth {
  double step = 0;           // 1/m, new step; a sample is off by at most half of it. 0 = kept
  double step_max = 0;       // 1/m, largest acceptable step
  std::string kept_because;  // reason why depth stays binary32; empty otherwise
};

// Turns every uncompressed DEPTH_F32 plane of the source into DEPTH_U16 with DISPARITY. All planes
// get one scale and offset. Surfaces become 1..65535 from the farthest to the nearest. The sky is
// exact. 0 means no surface, also for bad samples. `planes` are the planes of the source, in the
// order of the wire.
//
// Depth is not converted if a step would be more than w / f. w is 1/Z of the focal plane that a
// display takes (half way between the 2nd and the 98th percentile of surfaces). f is the larger of
// the source's focal length and 1000 px. Eyes up to half the focal distance to the side (a cone of
// 53 degrees) then see nothing move by more than 0.25 px.
QuantisedDepth quantiseDepth(v1::Source& source, std::span<SharedBytes> planes);

}  // namespace viewloom
