// SPDX-License-Identifier: Apache-2.0
// A frame as it goes over the wire: its header and the bytes of its planes.
#pragma once

#include <vector>

#include "base/byte_pool.h"
#include "viewloom/v1/frame.pb.h"

namespace viewloom {

// Copies of a frame share its planes, and so do messages on their way. Bytes of an offered frame
// must not change; the caller need not keep them.
struct WireFrame {
  v1::FrameHeader header;
  std::vector<SharedBytes> planes;  // in the header's order: sources, layers, planes
};

}  // namespace viewloom
