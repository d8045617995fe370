// SPDX-License-Identifier: Apache-2.0
// JPEG colour: passed on as it is when the wire takes it, else decoded.
#pragma once

#include <filesystem>

#include "files/plane_image.h"

namespace viewloom::files {

// JPEG (baseline, grey or YCbCr: the file's own bytes) or RGB8 (progressive and others, decoded).
// CMYK is refused.
absl::StatusOr<PlaneImage> readJpegColor(const std::filesystem::path& path);

}  // namespace viewloom::files
