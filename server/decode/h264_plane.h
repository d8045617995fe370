// SPDX-License-Identifier: Apache-2.0
// Colour planes in H.264.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/status.h"
#include "frame/size.h"

namespace viewloom {

// `wire`: any bytes; pictures as proto PLANE_ENCODING_H264 says. `out` becomes uint8_t[h][w][4],
// alpha 255. Refused before memory is taken for pictures: all that stillPicturesOf refuses. Damaged
// pictures are refused when they are decoded. Errors are INVALID_ARGUMENT without a field, or
// RESOURCE_EXHAUSTED. Each call has a decoder of its own, so no plane sees another's pictures or
// parameters. Thread-safety: may be called from any thread.
absl::Status decodeH264Plane(std::span<const uint8_t> wire, SizePx size_px,
                             std::vector<uint8_t>& out);

}  // namespace viewloom
