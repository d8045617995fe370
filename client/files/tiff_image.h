// SPDX-License-Identifier: Apache-2.0
// TIFF, read by libtiff.
#pragma once

#include <span>
#include <string>

#include "files/picture.h"

namespace viewloom::files {

// The first picture of the file, turned by its Orientation tag: grey and RGB of 8 and 16 bits as
// stored (white-is-zero turned round), other whole numbers and floats as binary32, in strips or
// tiles, of any compression that libtiff knows. Palettes, YCbCr and grey of fewer bits are read as
// colour alone. `name` is for messages.
absl::StatusOr<Picture> decodeTiff(const std::string& name, std::span<const uint8_t> bytes,
                                   PictureUse use);

}  // namespace viewloom::files
