// SPDX-License-Identifier: Apache-2.0
// PNG, read (8 and 16 bit colour, 8 and 16 bit grey as depth) and written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "base/status.h"
#include "files/picture.h"

namespace viewloom::files {

// Palettes are expanded. Turned by the eXIf chunk. Of colour, what the file says counts: of iCCP,
// sRGB, gAMA and cHRM the first that is there, as the PNG specification orders them. For depth,
// samples of less than 8 bits are refused.
absl::StatusOr<Picture> readPng(const std::filesystem::path& path, PictureUse use);

// The same of a file in memory; `name` is for messages.
absl::StatusOr<Picture> decodePng(const std::string& name, std::span<const uint8_t> bytes,
                                  PictureUse use);

// Colour in the form of colorPlane and depthPlane.
absl::StatusOr<PlaneImage> readPngColor(const std::filesystem::path& path, bool linear_samples);
absl::StatusOr<PlaneImage> readPngDepth(const std::filesystem::path& path, bool spread);

// samples: uint8_t[height_px][width_px][channels], packed, top row first; channels 1 (grey), 3
// (RGB) or 4 (RGBA). Returns the bytes of the file.
absl::StatusOr<std::string> encodePng(std::span<const uint8_t> samples, uint32_t width_px,
                                      uint32_t height_px, uint32_t channels);

// samples: uint16_t[height_px][width_px][3], RGB of 16 bits. Returns the bytes of the file.
absl::StatusOr<std::string> encodePng16(std::span<const uint16_t> samples, uint32_t width_px,
                                        uint32_t height_px);

}  // namespace viewloom::files
