// SPDX-License-Identifier: Apache-2.0
// PFM: portable float maps, bottom row first, of either byte order.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "files/picture.h"

namespace viewloom::files {

// "PF", three channels, or "Pf", grey. The scale's size is ignored, its sign is the byte order. The
// header may have comments and any white space, CR LF included. `name` is for messages.
absl::StatusOr<Picture> decodePfm(const std::string& name, std::span<const uint8_t> bytes);

// As colorPlane and depthPlane make it.
absl::StatusOr<PlaneImage> readPfmColor(const std::filesystem::path& path);
absl::StatusOr<PlaneImage> readPfmDepth(const std::filesystem::path& path);

}  // namespace viewloom::files
