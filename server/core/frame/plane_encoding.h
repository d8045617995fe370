// SPDX-License-Identifier: Apache-2.0
// Encodings that each kind of plane accepts, and sizes of their samples.
#pragma once

#include <cstdint>

#include "frame/frame.h"

namespace viewloom {

bool isEncodingOf(PlaneKind kind, PlaneEncoding encoding);
// All encodings of a kind, named as in proto: "R8, RGB8".
const char* encodingsOf(PlaneKind kind);
// Bytes of one pixel as sent; 0 for JPEG.
uint32_t wirePixelBytes(PlaneEncoding encoding);

}  // namespace viewloom
