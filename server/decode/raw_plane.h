// SPDX-License-Identifier: Apache-2.0
// Uncompressed planes: strides go, RGB8 becomes RGBA8.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "frame/frame.h"

namespace viewloom {

// True when the plane's uncompressed bytes are already what a Frame holds.
bool isPacked(const PlaneFormat& plane);

// `bytes` are the plane's uncompressed bytes, with its stride; `out` becomes the packed plane.
void packPlane(std::span<const uint8_t> bytes, const PlaneFormat& plane, std::vector<uint8_t>& out);

}  // namespace viewloom
