// SPDX-License-Identifier: Apache-2.0
// WebP, read by libwebp.
#pragma once

#include <span>
#include <string>

#include "files/picture.h"

namespace viewloom::files {

// Lossy and lossless: three channels, or four with alpha, of 8 bits; turned by the EXIF chunk.
// Animations are refused. `name` is for messages.
absl::StatusOr<Picture> decodeWebp(const std::string& name, std::span<const uint8_t> bytes);

}  // namespace viewloom::files
