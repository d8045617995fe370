// SPDX-License-Identifier: Apache-2.0
// Options of colour that a publisher sends as video.
#pragma once

#include <cstdint>

namespace viewloom {

struct ColorVideo {
  uint32_t qp = 22;          // quantisation, 20..51; less is better, and takes more bytes
  uint64_t area_min_px = 0;  // planes of fewer px are sent unchanged
};

}  // namespace viewloom
