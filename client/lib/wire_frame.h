// SPDX-License-Identifier: Apache-2.0
// A frame as it goes over the wire: its header and the bytes of its planes.
#pragma once

#include <vector>

#include "base/byte_pool.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom {

// Whoever holds a frame shares its planes, and so do messages under way: bytes that were offered
// must not change, and need not be kept.
struct WireFrame {
  v1::FrameHeader header;
  std::vector<SharedBytes> planes;  // in the header's order: sources, layers, planes
};

}  // namespace viewloom
