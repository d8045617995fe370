// SPDX-License-Identifier: Apache-2.0
// Depth packed into the channels of a colour picture.
#pragma once

#include <string>

#include "files/picture.h"

namespace viewloom::files {

// The word for --depth-packing: "rgb24".
const char* nameOf(v1::DepthPacking packing);

// The whole number that its digits make at white; 1 where they make none.
double codeMaxOf(v1::DepthPacking packing);

// Grey of floats, 0..1, white at 1; packings of a binary32 give its own number. Hues without a
// colour (black, white, grey) become NaN: nothing was measured. INVALID_ARGUMENT for pictures that
// are not 8 bits a channel, or lack a channel of the packing.
absl::StatusOr<Picture> unpackDepth(const std::string& file, const Picture& picture,
                                    v1::DepthPacking packing);

// The refusal of a coloured picture as depth: the packing that it looks like, and the way out.
std::string adviceForColor(const Picture& picture);

}  // namespace viewloom::files
