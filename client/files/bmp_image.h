// SPDX-License-Identifier: Apache-2.0
// BMP: uncompressed Windows bitmaps.
#pragma once

#include <span>
#include <string>

#include "files/picture.h"

namespace viewloom::files {

// 8 bits with a palette, 24 and 32 bits, and 16 and 32 bits of masks; either order of rows.
// Palettes of grey give one channel. Run-length coding and fewer bits are refused. `name` is for
// messages.
absl::StatusOr<Picture> decodeBmp(const std::string& name, std::span<const uint8_t> bytes);

}  // namespace viewloom::files
