// SPDX-License-Identifier: Apache-2.0
// Primaries and tone curve of an ICC profile of matrix and curves.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "files/color_coding.h"

namespace viewloom::files {

// By the colorants rXYZ, gXYZ and bXYZ. Nothing where they are of none of the primaries that the
// wire knows, or are no colorants.
std::optional<v1::ColorPrimaries> primariesOfIcc(std::span<const uint8_t> profile);

// Chromaticities of the known primaries and of Adobe RGB; the gamma of a curve that is a power, or
// a table that is near one. What the profile leaves open stays open.
ColorCoding codingOfIcc(std::span<const uint8_t> profile);

}  // namespace viewloom::files
