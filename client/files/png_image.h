// SPDX-License-Identifier: Apache-2.0
// PNG: 8 and 16 bit colour, 8 and 16 bit grey as depth.
#pragma once

#include <filesystem>

#include "files/picture.h"

namespace viewloom::files {

enum class PngUse { kColor, kDepth };

// Palettes are expanded and, for colour, grey: three or four channels. Gamma chunks are ignored.
// For depth, samples of less than 8 bits are refused.
absl::StatusOr<Picture> readPng(const std::filesystem::path& path, PngUse use);

// As colorPlane and depthPlane make it.
absl::StatusOr<PlaneImage> readPngColor(const std::filesystem::path& path, bool linear_samples);
absl::StatusOr<PlaneImage> readPngDepth(const std::filesystem::path& path, bool spread);

}  // namespace viewloom::files
