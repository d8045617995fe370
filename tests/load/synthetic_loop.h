// SPDX-License-Identifier: Apache-2.0
// A few moments of the synthetic scene, ready for the wire, to be sent round and round.
#pragma once

#include <cstdint>
#include <vector>

#include "frame/size.h"
#include "lib/wire_frame.h"

namespace viewloom::load {

// Raw RGBA8 and planar binary32 depth. Copies of the frames share their bytes.
std::vector<WireFrame> makeSyntheticLoop(SizePx size_px, uint32_t layer_count,
                                         uint32_t frame_count);

}  // namespace viewloom::load
