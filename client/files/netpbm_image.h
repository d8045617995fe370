// SPDX-License-Identifier: Apache-2.0
// Pictures of Netpbm: PGM and PPM, grey and colour of whole numbers, as text or binary; and PFM,
// floats, bottom row first, of either byte order.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "files/picture.h"

namespace viewloom::files {

// P2, P3, P5 and P6 with a maximum of 1..65535, which stands for white; binary samples above 255
// are big endian. The first picture of several. `name` is for messages.
absl::StatusOr<Picture> decodePnm(const std::string& name, std::span<const uint8_t> bytes);

// "PF", three channels, or "Pf", grey. The scale's size is ignored, its sign is the byte order. The
// header may have comments and any white space, CR LF included. `name` is for messages.
absl::StatusOr<Picture> decodePfm(const std::string& name, std::span<const uint8_t> bytes);

// Colour in the form of colorPlane and depthPlane.
absl::StatusOr<PlaneImage> readPfmColor(const std::filesystem::path& path);
absl::StatusOr<PlaneImage> readPfmDepth(const std::filesystem::path& path);

}  // namespace viewloom::files
