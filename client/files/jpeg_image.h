// SPDX-License-Identifier: Apache-2.0
// JPEG colour: passed on as it is when the wire takes it, else decoded.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "files/picture.h"

namespace viewloom::files {

// JPEG (baseline, grey or YCbCr: the file's own bytes) or RGB8 (progressive and others, decoded).
// CMYK is refused.
absl::StatusOr<PlaneImage> readJpegColor(const std::filesystem::path& path);

// The same pixels, always decoded to three channels.
absl::StatusOr<Picture> readJpeg(const std::filesystem::path& path);

// Of a whole file in memory; `name` is for messages.
absl::StatusOr<Picture> decodeJpeg(const std::string& name, std::span<const uint8_t> bytes);

}  // namespace viewloom::files
