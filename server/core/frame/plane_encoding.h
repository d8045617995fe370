// SPDX-License-Identifier: Apache-2.0
// Which encodings planes of a kind may have, and how large their samples are.
#pragma once

#include <cstdint>

#include "frame/frame.h"

namespace viewloom {

bool isEncodingOf(PlaneKind kind, PlaneEncoding encoding);
// All of a kind, as proto names them: "R8, RGB8".
const char* encodingsOf(PlaneKind kind);
// Bytes of one pixel in memory as sent; 0 for JPEG, which has none.
uint32_t wirePixelBytes(PlaneEncoding encoding);

}  // namespace viewloom
