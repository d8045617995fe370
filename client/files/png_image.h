// SPDX-License-Identifier: Apache-2.0
// PNG: 8 and 16 bit colour, 8 and 16 bit grey as depth.
#pragma once

#include <filesystem>

#include "files/plane_image.h"

namespace viewloom::files {

// RGB8 or RGBA8 as stored; 16 bits come as RGBA16F: sRGB decoded to linear light, or, when
// linear_samples, just divided by 65535. Palettes and grey are expanded; gamma chunks are ignored.
absl::StatusOr<PlaneImage> readPngColor(const std::filesystem::path& path, bool linear_samples);

// One channel, DEPTH_U16: 16 bits as stored; 8 bits as 0..255, or, when spread, 0..65535.
absl::StatusOr<PlaneImage> readPngDepth(const std::filesystem::path& path, bool spread);

}  // namespace viewloom::files
