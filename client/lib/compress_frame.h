// SPDX-License-Identifier: Apache-2.0
// Packs the planes of a frame with zstd where that makes them smaller.
#pragma once

#include "lib/wire_frame.h"

namespace viewloom {

// JPEG planes, planes already compressed and planes that would grow stay as they are.
// level: 1 (fast) .. 19.
WireFrame compressFrame(WireFrame frame, int level);

}  // namespace viewloom
