// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace viewloom {

// `rgb` holds whole pixels of RGB8; `rgba` has room for as many of RGBA8, which are opaque.
void widenRgb(std::span<const uint8_t> rgb, uint8_t* rgba);

}  // namespace viewloom
