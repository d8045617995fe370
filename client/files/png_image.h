// SPDX-License-Identifier: Apache-2.0
// PNG: 8 and 16 bit colour, 8 and 16 bit grey as depth.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "files/picture.h"

namespace viewloom::files {

// Palettes are expanded. Turned by the eXIf chunk. Of colour, what the file says counts: of iCCP,
// sRGB, gAMA and cHRM the first that is there, as the PNG specification orders them. For depth,
// samples of less than 8 bits are refused.
absl::StatusOr<Picture> readPng(const std::filesystem::path& path, PictureUse use);

// The same of a file in memory; `name` is for messages.
absl::StatusOr<Picture> decodePng(const std::string& name, std::span<const uint8_t> bytes,
                                  PictureUse use);

// As colorPlane and depthPlane make it.
absl::StatusOr<PlaneImage> readPngColor(const std::filesystem::path& path, bool linear_samples);
absl::StatusOr<PlaneImage> readPngDepth(const std::filesystem::path& path, bool spread);

}  // namespace viewloom::files
