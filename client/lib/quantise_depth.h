// SPDX-License-Identifier: Apache-2.0
// Binary32 depth as 16-bit inverse depth, where that is too fine to show.
#pragma once

#include <span>
#include <string>

#include "base/byte_pool.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom {

// What became of the binary32 depth of a source.
struct QuantisedDepth {
  double step = 0;      // 1/m, of what it is now; a sample is off by half of it at most. 0 = kept
  double step_max = 0;  // 1/m, the coarsest that would have been taken
  std::string kept_because;  // why depth stays binary32; empty when it does not, or has none
};

// Turns every uncompressed DEPTH_F32 plane of the source into DEPTH_U16 with DISPARITY, all of them
// with one scale and offset: 1..65535 from the farthest to the nearest surface, the sky exact, 0
// for no surface, bad samples among them. `planes` are the source's, in the order of the wire.
//
// Kept as it is when a step would be more than w / f: w is 1/Z of the focal plane a display takes
// (half way between the 2nd and the 98th percentile of surfaces), f the source's focal length or
// 1000 px, whichever is more. Eyes up to half the focal distance to the side, a cone of 53 degrees,
// then see nothing moved by more than 0.25 px.
QuantisedDepth quantiseDepth(v1::Source& source, std::span<SharedBytes> planes);

}  // namespace viewloom
