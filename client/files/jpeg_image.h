// SPDX-License-Identifier: Apache-2.0
// JPEG colour: passed on as it is when the wire takes it, else decoded.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "files/picture.h"

namespace viewloom::files {

// JPEG (baseline, grey or YCbCr, upright: the file's own bytes up to the end of its first picture)
// or RGB8 (progressive, turned by Exif, and others: decoded). Primaries by an ICC profile. CMYK and
// files that are cut short are refused.
absl::StatusOr<PlaneImage> readJpegColor(const std::filesystem::path& path);

// The same pixels, always decoded to three channels.
absl::StatusOr<Picture> readJpeg(const std::filesystem::path& path);

// The picture of a file in memory, turned by Exif; `name` is for messages.
absl::StatusOr<Picture> decodeJpeg(const std::string& name, std::span<const uint8_t> bytes);

}  // namespace viewloom::files
